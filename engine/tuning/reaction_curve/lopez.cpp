#include "engine/tuning/reaction_curve/lopez.h"

#include <map>
namespace tunewright {
namespace {

using enum ControllerKind;
using enum FittedCriterion;

const std::map<ControllerKind, std::map<FittedCriterion, ErrorIntegralRow>> kTable{
    {P, {{ise, {1.411, -0.917}}, {iae, {0.902, -0.985}}, {itae, {0.490, -1.084}}}},
    {PI,
     {{ise, {1.305, -0.959, 0.492, 0.739}},
      {iae, {0.984, -0.986, 0.608, 0.707}},
      {itae, {0.859, -0.977, 0.674, 0.680}}}},
    {PID,
     {{ise, {1.495, -0.945, 1.101, 0.771, 0.560, 1.006}},
      {iae, {1.435, -0.921, 0.878, 0.749, 0.482, 1.137}},
      {itae, {1.357, -0.947, 0.842, 0.738, 0.381, 0.995}}}},
};

Expected<TunedController> tune(const TuningProblem& problem, const LopezOptions& options) {
    const auto& row = kTable.at(options.controller).at(options.criterion);
    return tune_first_order(
        problem, options.model, {.name = "Lopez", .least = 0.1, .most = 1},
        [&](const ReducedModel& model) { return error_integral_settings(row, IntegralLaw::power, model); });
}

}  // namespace

TuningMethod lopez_method() {
    TuningMethod method;
    method.id = "lopez";
    method.title = "Lopez, load optimum";
    method.formula =
        "Kp = a1 (L/T)^b1/K, Ti = T (L/T)^b2/a2, Td = a3 T (L/T)^b3. PID, IAE: 1.435, -0.921, 0.878, 0.749, 0.482, "
        "1.137; ISE: 1.495, -0.945, 1.101, 0.771, 0.560, 1.006; ITAE: 1.357, -0.947, 0.842, 0.738, 0.381, 0.995. PI, "
        "IAE: 0.984, -0.986, 0.608, 0.707; ISE: 1.305, -0.959, 0.492, 0.739; ITAE: 0.859, -0.977, 0.674, 0.680. P, "
        "IAE: 0.902, -0.985; ISE: 1.411, -0.917; ITAE: 0.490, -1.084";
    method.source = "Lopez, Miller, Smith and Murrill, Instrumentation Technology 14 (1967) 57-62";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 1; made for load steps, with no regard to robustness";
    OptionSet<LopezOptions> options;
    add_controller(options, {P, PI, PID});
    add_criterion(options, {iae, ise, itae});
    options.embed(&LopezOptions::model, first_order_options());
    method.serve(options, tune);
    return method;
}

}  // namespace tunewright
