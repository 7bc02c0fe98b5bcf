// What the formulas of a product ask for beside the law: spans, sample time, clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/product/formula.h"
#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// In seconds, as far as it is known: the period in the settings, the caller's, the product's default.
struct Clocks {
    std::optional<double> sample_time;
    double firmware = 0;  ///< of a product of fixed clock
};
Clocks clocks_of(const Product& product, const Context& context);

/// Spans and sample time into the quantities; what is not given stands there as 1.
Quantities quantities_of(const Product& product, const Context& context);

/// The error that names what this parameter needs and nobody gave; none if all is there.
std::optional<Error> missing_for(const Product& product, const Parameter& parameter, const Context& context);

/// Of the filter, which may need the sample time without a parameter.
std::optional<Error> missing_for_filter(const Product& product, const Context& context);

/// What a caller has to give for this product: of "y_span", "u_span", "sample_time" those that some formula needs and
/// nothing else supplies.
std::vector<std::string> needs_of(const Product& product);

/// Whether a formula has used the firmware's clock.
bool uses_firmware_clock(const Product& product);

}  // namespace tunewright::product
