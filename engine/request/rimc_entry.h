// What an entry of the method rimc carries beside its controller's evaluation.
#pragma once

#include <optional>

#include "engine/evaluation/evaluate.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/tuning/rimc/rimc_report.h"

namespace tunewright {

/// The full controller of Eq. 23, dead time inside, on the plant as given.
struct FullController {
    Robustness robustness;
    LoadPerformance load;
    std::optional<Responses> responses;  ///< with points > 0 and a stable loop
};

/// Figures of the returned PID on the model that it was designed for; empty ones are explained in why_null.
struct RimcEntry {
    double lambda = 0;
    std::optional<double> Ms;
    std::optional<double> disturbance_peak;  ///< of y per unit of load, signed
    std::optional<double> dead_time_error;   ///< by Eq. 29, sufficient only
    std::optional<double> stability_limit;   ///< of lambda
    std::optional<FullController> full_controller;
    std::optional<DisturbancePeakCurve> disturbance_peak_curve;
    WhyNull why_null;
};

/// Actuator limits do not apply to the full controller; everything else of the options does.
RimcEntry rimc_entry(const RimcReport& report, const Plant& plant, const LinearPlant& linear,
                     const EvaluateOptions& options);

}  // namespace tunewright
