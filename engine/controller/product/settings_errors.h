// Standard errors of a product's settings from those of the law.
#pragma once

#include <map>
#include <string>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// One standard deviation of each number that gain or times of the law set, in the parameter's own unit, by its name:
/// central differences of to_settings over one standard deviation of Kp, Ti, Td, Tf and b (`errors`, by name, in the
/// caller's unit), added in squares as if these were independent. Parameters that do not move are left out.
std::map<std::string, double> settings_errors(const Product& product, const IdealPid& pid,
                                              const std::map<std::string, double>& errors, const Context& context);

}  // namespace tunewright::product
