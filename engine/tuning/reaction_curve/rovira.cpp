#include "engine/tuning/reaction_curve/rovira.h"

#include <map>
namespace tunewright {
namespace {

using enum ControllerKind;
using enum FittedCriterion;

const std::map<ControllerKind, std::map<FittedCriterion, ErrorIntegralRow>> kTable{
    {PI, {{iae, {0.758, -0.861, 1.020, -0.323}}, {itae, {0.586, -0.916, 1.030, -0.165}}}},
    {PID, {{iae, {1.086, -0.869, 0.740, -0.130, 0.348, 0.914}}, {itae, {0.965, -0.850, 0.796, -0.1465, 0.308, 0.929}}}},
};

Expected<TunedController> tune(const TuningProblem& problem, const RoviraOptions& options) {
    const auto& row = kTable.at(options.controller).at(options.criterion);
    return tune_first_order(
        problem, options.model, {.name = "Rovira", .least = 0.1, .most = 1},
        [&](const ReducedModel& model) { return error_integral_settings(row, IntegralLaw::line, model); });
}

}  // namespace

TuningMethod rovira_method() {
    TuningMethod method;
    method.id = "rovira";
    method.title = "Rovira, set-point optimum";
    method.formula =
        "Kp = a1 (L/T)^b1/K, Ti = T/(a2 + b2 L/T), Td = a3 T (L/T)^b3. PID, ITAE: 0.965, -0.850, 0.796, -0.1465, "
        "0.308, 0.929; IAE: 1.086, -0.869, 0.740, -0.130, 0.348, 0.914. PI, ITAE: 0.586, -0.916, 1.030, -0.165; IAE: "
        "0.758, -0.861, 1.020, -0.323";
    method.source = "Rovira, Murrill and Smith, Instruments & Control Systems 42 (1969) 67-69";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 1; made for set-point steps";
    OptionSet<RoviraOptions> options;
    add_controller(options, {PI, PID});
    add_criterion(options, {itae, iae});
    options.embed(&RoviraOptions::model, first_order_options());
    method.serve(options, tune);
    return method;
}

}  // namespace tunewright
