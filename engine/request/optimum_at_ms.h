// Excess of a controller's load IAE over the least that a PID reaches at the same Ms.
#pragma once

#include <optional>

#include <optional>

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/progress.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/pareto_front.h"

namespace tunewright {

/// `IAE`: of the robust PID whose limits on Ms and Mt are both the controller's Ms. `excess_percent`: 100 (IAE of the
/// controller over it - 1); may be below 0, because the controller's filter or Mt may differ from the optimum's. For a
/// nonlinear plant both are those of the linearisation, to which Ms belongs.
struct OptimumAtMs {
    Figure IAE, excess_percent;
};

/// The optima of one plant, each searched from its neighbours. Ms must lie in (1, 4]; for another Ms, or without an
/// optimum, both figures are empty. Evaluated with the steps, horizon and actuator of `options`; limits hold on the
/// nominal plant.
class RobustOptima {
public:
    RobustOptima(TuningProblem problem, const EvaluateOptions& options);
    RobustOptima(const RobustOptima&) = delete;  // pareto_front_ refers to the problem stored in this object
    RobustOptima& operator=(const RobustOptima&) = delete;

    OptimumAtMs compare_at_Ms(const Evaluation& evaluation, const RunControl& control);

private:
    Expected<double> load_IAE_at(double Ms, const RunControl& control);

    TuningProblem problem_;
    EvaluateOptions options_;
    ParetoFront front_;
};

/// The load IAE of the robust PI within the limits of a robust PID with these options, on the same plant. Empty if it
/// would need another search or is not comparable: for several plants, equations, another objective, or without such a
/// PI.
std::optional<double> best_PI_load_IAE(const TuningProblem& problem, const MethodOptions& of_pid,
                                       const EvaluateOptions& options, const RunControl& control);

}  // namespace tunewright
