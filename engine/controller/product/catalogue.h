// The products whose settings can be converted: one table in catalogue/, with a source file for each maker or group.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "engine/controller/product/product.h"

namespace tunewright::product {

/// All of them, by maker; ids are unique.
const std::vector<Product>& catalogue();

/// Null for an unknown id.
const Product* find(std::string_view id);

/// The groups, each in the source file of its name.
std::vector<Product> siemens_products();
std::vector<Product> rockwell_products();
std::vector<Product> schneider_products();
std::vector<Product> abb_products();
std::vector<Product> emerson_honeywell_products();
std::vector<Product> yokogawa_foxboro_products();
std::vector<Product> omron_mitsubishi_products();
std::vector<Product> small_plc_products();
std::vector<Product> panel_controller_products();
std::vector<Product> soft_plc_products();
std::vector<Product> open_plc_products();
std::vector<Product> mathworks_products();
std::vector<Product> library_products();
std::vector<Product> arduino_products();
std::vector<Product> laboratory_products();
std::vector<Product> printer_products();
std::vector<Product> thermostat_products();
std::vector<Product> kiln_and_brewery_products();
std::vector<Product> flight_products();

/// A call that makes a product's controller in its own language, so that such a text can be read.
struct Constructor {
    std::string_view product = "";              ///< id in the catalogue
    std::string_view function = "";             ///< as it is written
    std::vector<std::string_view> inputs = {};  ///< names of the parameters in the order of the call
    std::size_t required = 1;                   ///< inputs that every call has
    /// Named arguments that do not change the linear law, such as limits of the output.
    std::vector<std::string_view> outside = {};
};

/// All products that have one.
const std::vector<Constructor>& constructors();

}  // namespace tunewright::product
