// What the revised IMC design tells beside its controller.
#pragma once

#include <optional>

#include "engine/controller/imc_controller.h"
#include "engine/tuning/rimc/rimc_branch.h"
#include "engine/warning.h"

namespace tunewright {

/// Figures of the returned PID, with its filter, on the model that it was designed for.
struct RimcReport {
    ImcController full_controller;  ///< Eq. 23; holds lambda
    std::optional<double> Ms;
    std::optional<double> disturbance_peak;  ///< largest deviation of y per unit of load, signed
    std::optional<double> dead_time_error;   ///< the one that was asked for, else the largest up to which Eq. 29 holds
    std::optional<double> stability_limit;   ///< of lambda
    WhyNull why_null;
    std::optional<DisturbancePeakCurve> curve;  ///< with the option "curve"
};

}  // namespace tunewright
