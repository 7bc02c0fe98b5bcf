// What an entry of the method rimc carries beside its controller's evaluation.
#pragma once

#include <optional>

#include "engine/evaluate.h"
#include "engine/tuning/rimc_report.h"

namespace tunewright {

/// Figures of the returned PID on the model that it was designed for; empty ones are explained in why_null.
struct RimcEntry {
    double lambda = 0;
    std::optional<double> Ms;
    std::optional<double> disturbance_peak;  ///< of y per unit of load, signed
    std::optional<double> dead_time_error;   ///< by Eq. 29, sufficient only
    std::optional<double> stability_limit;   ///< of lambda
    std::optional<DisturbancePeakCurve> disturbance_peak_curve;
    WhyNull why_null;
};

RimcEntry rimc_entry(const RimcReport& report);

}  // namespace tunewright
