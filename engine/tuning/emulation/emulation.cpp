#include "engine/tuning/emulation/emulation.h"

#include "engine/number_text.h"
#include "engine/tuning/emulation/emulated_design.h"
#include "engine/tuning/emulation/level_one.h"
#include "engine/tuning/emulation/optimum_search.h"
#include "engine/tuning/emulation/options.h"
#include "engine/tuning/method/rule.h"

namespace tunewright {
namespace {

using namespace emulation;

constexpr int kSmallerSteps = 6;
constexpr double kSmaller = 3;

Error cancelled() { return {ErrorKind::cancelled, "", "The job was cancelled before a design was found."}; }

Error nothing_reaches(const std::string& reason) {
    return {ErrorKind::no_feasible_controller, "bounds",
            "No PID within the bounds runs to the horizon: " + reason +
                " Use other bounds, smaller steps or a shorter horizon."};
}

Expected<EmulatedDesign> approximate(const FixedErrorQp& remark6, const Bounds& bounds, double wu) {
    const auto point = remark6.best(bounds);
    if (!point)
        return Error{ErrorKind::no_feasible_controller, "bounds",
                     "Within the bounds the optimal gain is 0: the nonlinear controller's action does not depend on "
                     "the error, its integral or its derivative. Give bounds of Kp with the sign of the plant's gain."};
    const double J = remark6.J(*point);
    return EmulatedDesign{*point, bounds, J, J / wu, std::nullopt, false};
}

Expected<EmulatedDesign> full(const Criterion& criterion, const FixedErrorQp& remark6, const Bounds& bounds,
                              const std::vector<LevelOneRow>& rows, const RunControl& control) {
    std::vector<SettingsPoint> starts;
    if (auto point = remark6.best(bounds)) starts.push_back(std::move(*point));
    for (const LevelOneRow& row : rows)
        if (const IdealPid* pid = row.controller ? std::get_if<IdealPid>(&*row.controller) : nullptr)
            starts.push_back(point_of(criterion.problem(), *pid));
    const auto optimum = find_optimum(criterion, bounds, starts, control);
    if (!optimum) return cancelled();
    const Cost& cost = optimum->cost;
    if (!cost.ended.empty()) return optimum->stopped ? cancelled() : nothing_reaches(cost.ended);
    return EmulatedDesign{optimum->point, bounds, cost.J, cost.J_u, cost.J_y, optimum->stopped};
}

// If the nonlinear controller cannot perform the default step, that step was too large.
Expected<std::vector<Trajectory>> trajectories_of(EmulationProblem& problem, const RunControl& control) {
    auto trajectories = nonlinear_trajectories(problem, control);
    for (int i = 0; i < kSmallerSteps && problem.default_scenario; ++i) {
        if (trajectories || trajectories.error().kind != ErrorKind::unsupported) break;
        problem.scenarios.front().setpoint_step /= kSmaller;
        trajectories = nonlinear_trajectories(problem, control);
    }
    if (problem.default_scenario && trajectories)
        problem.warnings.push_back({"default-scenario", "No scenarios are given: one set-point step of " +
                                                            text(problem.scenarios.front().setpoint_step) +
                                                            " is used. Give the steps that occur in the loop."});
    return trajectories;
}

Expected<TunedController> tune(const TuningProblem& plant, const EmulationOptions& options, const RunControl& control) {
    auto stated = state_problem(plant, options);
    if (!stated) return stated.error();
    EmulationProblem& problem = *stated;
    const auto trajectories = trajectories_of(problem, control);
    if (!trajectories) return trajectories.error();
    auto rows = level_one(problem, control);
    if (!rows) return rows.error();
    const auto bounds = search_bounds(problem, *rows);
    if (!bounds) return bounds.error();
    const Criterion criterion(problem, *trajectories);
    const FixedErrorQp remark6(problem, *trajectories);
    const auto design =
        problem.remark6 ? approximate(remark6, *bounds, problem.wu) : full(criterion, remark6, *bounds, *rows, control);
    if (!design) return design.error();
    EmulationReport report = report_of(criterion, remark6, *design, std::move(*rows), control.stop);
    std::vector<Warning> warnings = remarks(report);
    warnings.insert(warnings.end(), problem.warnings.begin(), problem.warnings.end());
    auto answer = rule_answer(controller_at(problem, design->point), std::move(warnings));
    if (!answer) return answer;
    answer->report = std::make_shared<EmulationReport>(std::move(report));
    answer->partial = control.stop.stop_requested();
    return answer;
}

}  // namespace

TuningMethod emulation_method() {
    TuningMethod method;
    method.id = kEmulation;
    method.title = "Emulation of a nonlinear controller";
    method.formula =
        "minimise over Kp, Ti, Td the mean over scenarios of int_0^t_f [wy (y_nl - y)^2 + wu (u_nl - u)^2] dt; y_nl, "
        "u_nl: the run with u = (v - sum_k beta_k L_f^k h)/(beta_r L_g L_f^(r-1) h); Kp, Ti, Td: within alpha_low and "
        "alpha_high times classical settings; t_f: the horizon; remark6: error taken from y_nl, wy = 0";
    method.source =
        "Mhaskar, El-Farra and Christofides, A method for PID controller tuning using nonlinear control techniques, "
        "American Control Conference (2004)";
    method.needs = "differential equations that are affine in the input, or a linear plant without direct term";
    method.validity =
        "operating conditions that a PID can stabilise; a warning says if the PID does not reproduce much of the "
        "nonlinear controller's action (Remark 7)";
    method.all_if_nonlinear = true;
    method.bind(described_options(), tune);
    return method;
}

}  // namespace tunewright
