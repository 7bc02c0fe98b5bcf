#include "engine/controller/product/catalogue.h"

#include <algorithm>
#include <iterator>

namespace tunewright::product {
namespace {

std::vector<Product> collected() {
    using Group = std::vector<Product> (*)();
    constexpr Group kGroups[] = {siemens_products,
                                 rockwell_products,
                                 schneider_products,
                                 abb_products,
                                 emerson_honeywell_products,
                                 yokogawa_foxboro_products,
                                 omron_mitsubishi_products,
                                 small_plc_products,
                                 panel_controller_products,
                                 soft_plc_products,
                                 open_plc_products,
                                 laboratory_products,
                                 mathworks_products,
                                 library_products,
                                 arduino_products,
                                 printer_products,
                                 thermostat_products,
                                 kiln_and_brewery_products,
                                 flight_products};
    std::vector<Product> all;
    for (const Group group : kGroups) {
        std::vector<Product> products = group();
        std::move(products.begin(), products.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace

const std::vector<Product>& catalogue() {
    static const std::vector<Product> all = collected();
    return all;
}

const Product* find(std::string_view id) {
    const auto& all = catalogue();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Product& product) { return product.id == id; });
    return found == all.end() ? nullptr : &*found;
}

// The order of the inputs is that of the makers' documents, which the catalogue names as sources.
const std::vector<Constructor>& constructors() {
    static const std::vector<Constructor> all{
        {.product = "matlab_pid", .function = "pid", .inputs = {"Kp", "Ki", "Kd", "Tf"}},
        {.product = "matlab_pidstd", .function = "pidstd", .inputs = {"Kp", "Ti", "Td", "N"}},
        {.product = "matlab_pid2", .function = "pid2", .inputs = {"Kp", "Ki", "Kd", "Tf", "b", "c"}},
        {.product = "matlab_pidstd2", .function = "pidstd2", .inputs = {"Kp", "Ti", "Td", "N", "b", "c"}},
        {.product = "controlsystems_jl_pid",
         .function = "pid",
         .inputs = {"param_p", "param_i", "param_d"},
         .required = 2},
        {.product = "discretepids_jl", .function = "DiscretePID", .required = 0, .outside = {"umin", "umax"}},
        {.product = "modelica_limpid",
         .function = "LimPID",
         .required = 0,
         .outside = {"yMax", "yMin", "Ni", "initType", "xi_start", "xd_start", "y_start", "homotopyType", "strict",
                     "limitsAtInit"}},
    };
    return all;
}

}  // namespace tunewright::product
