// The user's own rule: a formula for each parameter, in figures of the plant's model.
#pragma once

#include <optional>
#include <string>

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct FormulaOptions {
    std::string Kp, Ti, Td;  ///< "" for Ti: no integral action; for Td: no derivative
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

/// Kp, Ti and Td of the ideal form as expressions (engine/plant/expression) of
///
///     K, T, L   of K e^(-Ls)/(T s + 1), the plant or its reduction; T2 with a second lag of the plant's own form;
///               with an integrator K and T are infinite
///     Kv        K/T, with an integrator the slope
///     tau       L/(L + T), 0 with an integrator
///     Ku, Pu    ultimate gain and period, with the exact dead time; computed only if a formula uses them
///
/// Errors: invalid_argument, `where` "Kp", "Ti" or "Td", for a formula that cannot be read or uses an unknown name;
/// unsupported for one without a value on this plant; those of reduce() and of the ultimate point.
TuningMethod formula_method();

}  // namespace tunewright
