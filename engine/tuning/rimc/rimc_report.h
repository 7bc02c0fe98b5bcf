// The report of the revised IMC design.
#pragma once

#include <optional>

#include "engine/controller/imc_controller.h"
#include "engine/figure.h"
#include "engine/tuning/method/method_report.h"
#include "engine/tuning/rimc/rimc_branch.h"

namespace tunewright {

/// The full controller of Eq. 23, with its dead time, on the given plant.
struct FullController {
    Robustness robustness;
    LoadPerformance load;
    std::optional<Responses> responses;  ///< with points > 0 and a stable loop
};

/// Figures of the returned PID, with its filter, on the model of its design.
struct RimcReport : MethodReport {
    ImcController controller;  ///< Eq. 23; contains lambda
    Figure Ms;
    Figure disturbance_peak;  ///< largest deviation of y per unit of load, signed
    Figure dead_time_error;   ///< the requested one, else the largest up to which Eq. 29 holds
    Figure stability_limit;   ///< of lambda
    OrReason<FullController> full_controller;
    std::optional<DisturbancePeakCurve> curve;  ///< with the option "curve"

    /// Evaluates the full controller on the plant. It ignores actuator limits but applies all other options.
    void complete(const ReportContext& context, Evaluation& evaluation) override;
};

}  // namespace tunewright
