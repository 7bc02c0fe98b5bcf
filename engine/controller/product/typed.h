// Settings as entered into a block: the values that it accepts, their rounding, and the meaning of missing ones.
#pragma once

#include <optional>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// Error of the first setting whose name or value the product does not accept.
std::optional<Error> wrong_setting(const Product& product, const Settings& settings);

/// The value of that name; null if it is missing.
const Value* setting_named(const Settings& settings, std::string_view name);

/// A numeric parameter's value, or the maker's default if none is given; empty if neither is known.
std::optional<double> number_of(const Parameter& parameter, const Settings& settings);

/// The chosen option. If none is given, the first option with which every given setting has an effect, else the first.
/// The parameter has options.
const Option& option_of(const Product& product, const Parameter& parameter, const Settings& settings);

/// True if the parameter has an effect with the options in `settings`: weights of a structure that is not chosen, and
/// the time of an action that is switched off, have none.
bool counts(const Product& product, const Parameter& parameter, const Settings& settings);

/// 1 - b from Omron's code: "100".."199" in hundredths, "000" the block's default 0.65; empty for anything else.
std::optional<double> decoded_alpha(const Value& code);
std::string encoded_alpha(double alpha);

/// Rounded to the resolution and limited to the range; `off` stays.
double rounded(const Parameter& parameter, double value);

/// "0 to 1000 %", "at least 1".
std::string range_text(const Parameter& parameter);

}  // namespace tunewright::product
