// The inputs that a product's formulas need as well as the law: spans, sample time, clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/product/formula.h"
#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// Periods in seconds, if known: from the settings, from the caller, or the product's default.
struct Clocks {
    std::optional<double> sample_time;
    double firmware = 0;  ///< of a product with a fixed clock
};
Clocks clocks_of(const Product& product, const Context& context);

/// Puts spans and sample time into the quantities; a missing one is 1.
Quantities quantities_of(const Product& product, const Context& context);

/// The error that names a missing input of this parameter; none if all are given.
std::optional<Error> missing_for(const Product& product, const Parameter& parameter, const Context& context);

/// The same for the filter, which may need the sample time without having a parameter.
std::optional<Error> missing_for_filter(const Product& product, const Context& context);

/// The inputs that a caller must give for this product: those of "y_span", "u_span", "sample_time" that a formula needs
/// and nothing else supplies.
std::vector<std::string> needs_of(const Product& product);

/// True if a formula uses the firmware's clock.
bool uses_firmware_clock(const Product& product);

}  // namespace tunewright::product
