#include "engine/tuning/emulation/emulated_design.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "engine/number_text.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/tuning/emulation/emulation_problem.h"
#include "engine/tuning/emulation/optimum_search.h"

namespace tunewright::emulation {

namespace {

constexpr double kFlatnessRise = 0.05;  // increase of J that defines the flatness

// Possible change of each unknown until J has risen by kFlatnessRise: with the others re-optimised, or fixed (alone).
struct Flatness {
    std::vector<double> reoptimised, alone;
};

constexpr double kFirstStep = 1e-3;   // relative to the unknown
constexpr double kRiseSought = 2e-3;  // increase of J, relative, at the steps of the differences
constexpr double kMaxStep = 0.3;
constexpr int kStepRounds = 8;

// Steps to either side at which the curvature of J is well above rounding and still that of the optimum.
struct Differences {
    SettingsPoint step, curvature;
};

double second_difference(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& at, double J0,
                         std::size_t i, double step) {
    SettingsPoint up = at, down = at;
    up[i] += step;
    down[i] -= step;
    return (J(up) - 2 * J0 + J(down)) / (step * step);
}

std::optional<Differences> measure(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& at,
                                   const SettingsPoint& sizes, double J0) {
    Differences found{SettingsPoint(at.size()), SettingsPoint(at.size())};
    for (std::size_t i = 0; i < at.size(); ++i) {
        double step = kFirstStep * sizes[i];
        for (int round = 0; round < kStepRounds; ++round) {
            found.step[i] = step;
            found.curvature[i] = second_difference(J, at, J0, i, step);
            const double rise = 0.5 * found.curvature[i] * step * step / J0;
            if (rise > kRiseSought / 4 && rise < kRiseSought * 4) break;
            const double factor = rise > 0 ? std::sqrt(kRiseSought / rise) : 10;
            step = std::min(step * std::clamp(factor, 0.01, 30.0), kMaxStep * sizes[i]);
        }
        if (!(found.curvature[i] > 0)) return std::nullopt;
    }
    return found;
}

// From the Hessian of J at the optimum. `J` is finite near it, on both sides of bounds; `sizes` are the typical sizes
// of the unknowns. The curvature of an optimum on a bound is used too. Empty if the curvature is not above rounding.
std::optional<Flatness> flatness(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& optimum,
                                 const SettingsPoint& sizes) {
    const std::size_t n = optimum.size();
    const double J0 = J(optimum);
    if (!(J0 > 0)) return std::nullopt;
    const auto found = measure(J, optimum, sizes, J0);
    if (!found) return std::nullopt;
    std::vector<double> H(n * n, 0);  // in units of the steps
    for (std::size_t i = 0; i < n; ++i) H[i * n + i] = found->curvature[i] * found->step[i] * found->step[i];
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            double mixed = 0;
            for (const int a : {1, -1})
                for (const int b : {1, -1}) {
                    SettingsPoint moved = optimum;
                    moved[i] += a * found->step[i];
                    moved[j] += b * found->step[j];
                    mixed += a * b * J(moved);
                }
            H[i * n + j] = H[j * n + i] = mixed / 4;
        }
    Flatness flat;
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<double> unit(n, 0);
        unit[i] = 1;
        const auto column = solve(H, unit, static_cast<int>(n));
        if (!column || !((*column)[i] > 0)) return std::nullopt;
        flat.reoptimised.push_back(found->step[i] * std::sqrt(2 * kFlatnessRise * J0 * (*column)[i]));
        flat.alone.push_back(std::sqrt(2 * kFlatnessRise * J0 / found->curvature[i]));
    }
    return flat;
}

constexpr double kMaxBoundDistance = 1e-6;  // of the range
constexpr double kMaxUnexplainedU = 0.1;    // of int u_nl^2: above it a PID cannot emulate (Remark 7)
constexpr double kMaxUnexplainedY = 0.05;   // of int y_nl^2, in the same way
constexpr int kReportedIntervals = 400;     // of a run in the answer

// The answer has every stride-th sample.
std::size_t stride(const EmulationProblem& problem) {
    return static_cast<std::size_t>(problem.intervals / kReportedIntervals);
}

std::vector<double> thinned(const std::vector<double>& samples, double rest, std::size_t stride) {
    std::vector<double> values;
    for (std::size_t i = 0; i < samples.size(); i += stride) values.push_back(rest + samples[i]);
    return values;
}

std::vector<double> thinned_times(std::size_t samples, const EmulationProblem& problem) {
    std::vector<double> times;
    for (std::size_t i = 0; i < samples; i += stride(problem))
        times.push_back(problem.horizon * static_cast<double>(i) / problem.intervals);
    return times;
}

double share_left(const std::vector<double>& wanted, const std::vector<double>& done, double size,
                  const std::vector<double>& weights) {
    double left = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double difference = wanted[i] - (i < done.size() ? done[i] : 0);
        left += weights[i] * difference * difference;
    }
    return size > 0 ? left / size : 0;
}

std::string percent(double share) { return text(100 * share) + " %"; }

void judge_fit(EmulationFit& fit) {
    fit.adequate = fit.u_left <= kMaxUnexplainedU && fit.y_left <= kMaxUnexplainedY;
    const std::string figures =
        "u differs from the nonlinear controller by " + percent(fit.u_left) + " (squared), y by " + percent(fit.y_left);
    fit.sentence = fit.adequate ? "The PID follows the nonlinear controller: " + figures + "."
                                : "No PID within the bounds follows this nonlinear controller: " + figures +
                                      " (up to " + percent(kMaxUnexplainedU) + " and " + percent(kMaxUnexplainedY) +
                                      " count as following). Ask for a slower target, smaller steps or wider bounds, "
                                      "or implement the nonlinear controller itself.";
}

void add_scenarios(EmulationReport& report, const Criterion& criterion, const IdealPid& pid) {
    const EmulationProblem& problem = criterion.problem();
    const std::vector<double> weights = simpson_weights(problem);
    const std::size_t every = stride(problem);
    for (std::size_t i = 0; i < problem.scenarios.size(); ++i) {
        const Scenario& asked = problem.scenarios[i];
        const Trajectory& wanted = criterion.trajectories()[i];
        const PidRun done = criterion.run(i, pid, kFineTolerance);
        const double share = 1 / static_cast<double>(problem.scenarios.size());
        report.fit.u_left += share * share_left(wanted.u_nl, done.u, wanted.u_size, weights);
        report.fit.y_left += share * share_left(wanted.y_nl, done.y, wanted.y_size, weights);
        EmulatedScenario row;
        row.setpoint_step = asked.setpoint_step;
        row.initial = asked.initial;
        row.parameters = asked.parameters;
        row.y_rest = asked.system->y_steady();
        row.u_rest = asked.system->u_nominal();
        row.t = thinned_times(wanted.y_nl.size(), problem);
        row.y_nl = thinned(wanted.y_nl, row.y_rest, every);
        row.u_nl = thinned(wanted.u_nl, row.u_rest, every);
        row.y = thinned(done.y, row.y_rest, every);
        row.u = thinned(done.u, row.u_rest, every);
        row.limited = wanted.limited;
        row.ended = done.ended;
        report.scenarios.push_back(std::move(row));
    }
    judge_fit(report.fit);
}

void add_runs(LevelOneRow& row, const Criterion& criterion, const FixedErrorQp& remark6, const std::stop_token& stop) {
    const IdealPid* pid = row.controller ? std::get_if<IdealPid>(&*row.controller) : nullptr;
    if (pid == nullptr || stop.stop_requested()) return;
    const EmulationProblem& problem = criterion.problem();
    const Judgement judgement = judge(criterion, remark6, point_of(problem, *pid));
    row.J = judgement.J;
    row.ended = judgement.ended;
    const PidRun run = criterion.run(0, *pid, kFineTolerance);
    if (row.ended.empty()) row.ended = run.ended;
    const std::size_t every = stride(problem);
    row.t = thinned_times(run.y.size(), problem);
    row.y = thinned(run.y, problem.scenarios.front().system->y_steady(), every);
    row.u = thinned(run.u, problem.scenarios.front().system->u_nominal(), every);
}

void add_bounds(EmulationReport& report, const EmulationProblem& problem, const EmulatedDesign& design) {
    const auto names = unknowns(problem);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const double low = design.bounds.low[i], high = design.bounds.high[i], value = design.point[i];
        report.bounds[names[i]] = {low, high};
        const double near = kMaxBoundDistance * (high - low);
        if (value - low > near && high - value > near) continue;
        report.active_bounds.push_back({names[i], high - value <= near, high - value <= near ? high : low});
    }
}

void add_flatness(EmulationReport& report, const Criterion& criterion, const FixedErrorQp& remark6,
                  const EmulatedDesign& design, const std::stop_token& stop) {
    const EmulationProblem& problem = criterion.problem();
    const SettingsPoint sizes = sizes_of(design.point, design.bounds);
    const auto J = [&](const SettingsPoint& point) {
        if (stop.stop_requested()) return 0.0;
        return problem.remark6 ? remark6.J(point)
                               : criterion.penalised(criterion.cost(controller_at(problem, point), kFineTolerance));
    };
    const auto flat = flatness(J, design.point, sizes);
    if (!flat || stop.stop_requested()) return;
    const auto names = unknowns(problem);
    for (std::size_t i = 0; i < names.size(); ++i) {
        report.flatness[names[i]] = flat->reoptimised[i];
        report.flatness_alone[names[i]] = flat->alone[i];
    }
}

Warning at_bound(const ActiveBound& bound) {
    if (bound.parameter == "Td" && bound.value == 0)
        return {"at-bound", "Td is at its lower bound 0: a derivative part does not help here, and a PI is as good."};
    return {"at-bound", bound.parameter + " is at its " + (bound.high ? "upper" : "lower") + " bound " +
                            text(bound.value) +
                            ": J would be lower beyond it. Widen bounds, or alpha, if such values are acceptable."};
}

}  // namespace

Judgement judge(const Criterion& criterion, const FixedErrorQp& remark6, const SettingsPoint& point) {
    if (criterion.problem().remark6) return {remark6.J(point), {}};
    const Cost cost = criterion.cost(controller_at(criterion.problem(), point), kFineTolerance);
    if (!cost.ended.empty() || !std::isfinite(cost.J)) return {std::nullopt, cost.ended};
    return {cost.J, {}};
}

EmulationReport report_of(const Criterion& criterion, const FixedErrorQp& remark6, const EmulatedDesign& design,
                          std::vector<LevelOneRow> level_one, const std::stop_token& stop) {
    const EmulationProblem& problem = criterion.problem();
    EmulationReport report;
    report.formulation = problem.remark6 ? "remark6" : "full";
    report.J = design.J;
    report.J_y = design.J_y;
    report.J_u = design.J_u;
    report.wy = problem.wy;
    report.wu = problem.wu;
    report.horizon = problem.horizon;
    report.relative_degree = problem.relative_degree;
    report.zero_dynamics_stable = problem.zero_dynamics.stable;
    report.zeros = problem.zero_dynamics.zeros;
    report.beta = problem.target.beta;
    add_bounds(report, problem, design);
    add_scenarios(report, criterion, controller_at(problem, design.point));
    report.level1 = std::move(level_one);
    for (LevelOneRow& row : report.level1) add_runs(row, criterion, remark6, stop);
    if (!stop.stop_requested()) add_flatness(report, criterion, remark6, design, stop);
    return report;
}

std::vector<Warning> remarks(const EmulationReport& report) {
    std::vector<Warning> warnings;
    if (!report.fit.adequate) warnings.push_back({"cannot-emulate", report.fit.sentence});
    if (!report.zero_dynamics_stable)
        warnings.push_back({"unstable-zero-dynamics",
                            "The plant's zero dynamics are unstable at the operating point: with the nonlinear "
                            "controller y follows its target, but the internal states are unbounded. Its run to the "
                            "horizon is emulated in spite of that; a robust design is safer."});
    for (std::size_t i = 0; i < report.scenarios.size(); ++i) {
        const EmulatedScenario& scenario = report.scenarios[i];
        const std::string which = report.scenarios.size() > 1 ? " of scenario " + std::to_string(i + 1) : "";
        if (scenario.limited)
            warnings.push_back({"nonlinear-controller-limited",
                                "A limit of the input clips the nonlinear controller's run" + which +
                                    ", so y does not follow the target there, and the PID emulates the clipped run."});
        if (!scenario.ended.empty())
            warnings.push_back({"left-domain", "The PID's run" + which + " ends early: " + scenario.ended});
    }
    for (const ActiveBound& bound : report.active_bounds) warnings.push_back(at_bound(bound));
    return warnings;
}

}  // namespace tunewright::emulation
