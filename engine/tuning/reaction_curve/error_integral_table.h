// Settings fitted to optima of an error integral over L/T: one shape, many tables.
#pragma once

#include "engine/reduction/reduction.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// How Ti follows q = L/T.
enum class IntegralLaw {
    power,  ///< Ti = T q^b2/a2: fits to load steps
    line,   ///< Ti = T/(a2 + b2 q): fits to set-point steps
};

/// K Kp = a1 q^b1; Ti by the law, no integral action with a2 = 0; Td/T = a3 q^b3.
struct ErrorIntegralRow {
    double a1, b1, a2 = 0, b2 = 0, a3 = 0, b3 = 0;
};

/// `model`: first order, T > 0, L > 0.
Pid error_integral_settings(const ErrorIntegralRow& row, IntegralLaw law, const ReducedModel& model);

/// Option `criterion` with these choices, the first as default.
OptionDescription criterion_option(std::vector<std::string> choices);

}  // namespace tunewright
