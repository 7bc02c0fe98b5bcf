#include "engine/structure/level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "engine/blocks/diagram_response.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/number_text.h"
#include "engine/structure/drawing/view.h"

namespace tunewright::structure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLowestRateZeta = 0.4;
constexpr double kFrontier[] = {0.3, 0.4, 0.5, 0.6, 0.7071067811865476, 0.85, 1, 1.25, 1.5, 2};
constexpr double kNearOne = 1e-6;  // of zeta^2 - 1: the limits of the formulas at zeta = 1

/// acos(zeta)/sqrt(1 - zeta^2), continued to zeta >= 1.
double turn(double zeta) {
    const double x = 1 - zeta * zeta;
    if (std::abs(x) < kNearOne) return 1 + (1 - zeta) / 3;  // the series at 1
    return x > 0 ? std::acos(zeta) / std::sqrt(x) : std::acosh(zeta) / std::sqrt(-x);
}

/// E(zeta): the highest level over D/(A w).
double rise(double zeta) { return std::exp(-zeta * turn(zeta)); }

/// The largest rate of the outflow over D w; for zeta >= 1/2 it is that at the beginning.
double rate(double zeta) {
    if (zeta >= 0.5) return 2 * zeta;
    const double angle = std::asin(zeta);
    return std::exp(-zeta * (std::numbers::pi / 2 - 3 * angle) / std::cos(angle));
}

LevelDesign proportional(const LevelProblem& problem, double Kc) {
    LevelDesign out;
    out.Kc = Kc;
    out.Ti = kInfinity;
    out.highest = problem.gap + problem.step / Kc;
    out.time_of_highest = kInfinity;
    out.largest_rate = Kc * problem.step / problem.area;
    return out;
}

double bound_of(const LevelProblem& problem) {
    return problem.step * problem.step / (2 * problem.area * problem.allowed);
}

LevelDesign of_zeta(const LevelProblem& problem, double zeta) {
    const double w = problem.step * rise(zeta) / (problem.area * problem.allowed), Kc = 2 * zeta * w * problem.area;
    return judge_level(problem, Kc, 2 * zeta / w);
}

/// The gain of a proportional controller that uses the room outside the gap.
double gain_alone(const LevelProblem& problem) { return problem.step / (problem.allowed - problem.gap); }

std::optional<Error> refused(const LevelProblem& problem) {
    const auto positive = [](const char* where, double value) -> std::optional<Error> {
        if (value > 0 && std::isfinite(value)) return std::nullopt;
        return Error{ErrorKind::invalid_argument, where,
                     std::string(where) + " is " + text(value) + "; it must be above 0."};
    };
    if (auto error = positive("volume", problem.area)) return error;
    if (auto error = positive("largest_step", problem.step)) return error;
    if (auto error = positive("allowed", problem.allowed)) return error;
    if (auto error = positive("zeta", problem.zeta)) return error;
    if (!(problem.gap >= 0 && problem.gap < problem.allowed))
        return Error{ErrorKind::invalid_argument, "gap",
                     "gap is " + text(problem.gap) + "; it must be at least 0 and below the allowed deviation " +
                         text(problem.allowed) + "."};
    const bool integrates = problem.given ? problem.given->Ti.has_value() : problem.aim != LevelAim::no_overshoot;
    if (problem.gap > 0 && integrates)
        return Error{ErrorKind::invalid_argument, "gap",
                     "A gap is for proportional action alone; give the aim no_outflow_overshoot, or no gap."};
    if (problem.flow && !(problem.flow->T >= 0 && problem.flow->L >= 0))
        return Error{ErrorKind::invalid_argument, "flow_loop",
                     "The lag and the dead time of the flow loop must not be below 0."};
    return std::nullopt;
}

Figure Ms_of(const LevelProblem& problem, const LevelDesign& design) {
    if (!problem.flow) return no_figure("The flow loop is not given.");
    Zpk plant{.K = 1 / problem.area, .zeros = {}, .poles = {0.0}, .L = problem.flow->L};
    if (problem.flow->T > 0) {
        plant.poles.emplace_back(-1 / problem.flow->T);
        plant.K /= problem.flow->T;
    }
    const auto linear = LinearPlant::make(Plant(plant));
    if (!linear) return no_figure(linear.error().message);
    const auto loop = Loop::make(*linear, to_parallel(IdealPid{.Kp = design.Kc, .Ti = design.Ti}));
    if (const auto peaks = stable_peaks(loop)) return peaks->S.value;
    return no_figure("With this flow loop the level is not stable: allow it more room.");
}

/// The highest level and the largest rate of the outflow after the largest step, with the flow loop.
void add_simulated(const LevelProblem& problem, LevelResult& out) {
    out.highest = out.largest_rate =
        no_figure(problem.gap > 0 ? "A controller with a gap is not simulated here." : out.Ms.why);
    if (!out.Ms || problem.gap > 0) return;
    const auto view = level_view(problem, out.design);
    if (!view) return;
    const NamedSignal &inflow = view->inputs.front(), &level = view->outputs.front(), &outflow = view->outputs.back();
    const auto response = DiagramResponse::of(view->diagram, {{inflow.signal, problem.step}}, {});
    if (!response) return;
    double highest = 0, rate = 0;
    for (const ResponseNode& node : response->pair(level.signal, outflow.signal, 0).nodes) {
        highest = std::max(highest, node.y);
        rate = std::max(rate, std::abs(node.u_slope));
    }
    out.highest = highest;
    out.largest_rate = rate;
}

LevelDesign design_of(const LevelProblem& problem) {
    if (problem.given) return judge_level(problem, problem.given->Kc, problem.given->Ti.value_or(kInfinity));
    switch (problem.aim) {
        case LevelAim::rate: return of_zeta(problem, kLowestRateZeta);
        case LevelAim::zeta: return of_zeta(problem, problem.zeta);
        case LevelAim::no_overshoot: break;
    }
    return judge_level(problem, gain_alone(problem), kInfinity);
}

}  // namespace

LevelDesign judge_level(const LevelProblem& problem, double Kc, double Ti) {
    LevelDesign out = proportional(problem, Kc);
    if (std::isfinite(Ti)) {
        out.Ti = Ti;
        out.w = std::sqrt(Kc / (problem.area * Ti));
        out.zeta = 0.5 * std::sqrt(Kc * Ti / problem.area);
        const double E = rise(out.zeta);
        out.highest = problem.step * E / (problem.area * out.w);
        out.time_of_highest = turn(out.zeta) / out.w;
        out.largest_rate = rate(out.zeta) * problem.step * out.w;
        out.overshoot_percent = 100 * E * E;
    }
    out.rate_over_bound = out.largest_rate / bound_of(problem);
    return out;
}

Expected<LevelResult> design_level(const LevelProblem& problem) {
    if (auto error = refused(problem)) return *error;
    LevelResult out;
    out.bound = bound_of(problem);
    out.design = design_of(problem);
    out.Ms = Ms_of(problem, out.design);
    add_simulated(problem, out);
    for (const double zeta : kFrontier) out.frontier.push_back(of_zeta(problem, zeta));
    out.frontier.push_back(judge_level(problem, gain_alone(problem), kInfinity));
    return out;
}

Expected<StructureView> level_view(const LevelProblem& problem, const LevelDesign& design) {
    BlockDiagram all;
    const int level = all.add_signal(), outflow = all.add_signal(), volume = all.add_signal();
    // A higher level needs a larger outflow: direct action.
    const auto pid = add_pid(all, to_parallel(IdealPid{.Kp = -design.Kc, .Ti = design.Ti}), level);
    if (!pid) return pid.error();
    const FlowLoop flow = problem.flow.value_or(FlowLoop{});
    if (flow.T > 0)
        all.add(pid->output, outflow,
                std::move(*LinearPlant::make(Plant(TransferFunction{.num = {1}, .den = {flow.T, 1}, .L = flow.L}))));
    else
        all.add(pid->output, outflow, 1, flow.L);
    all.add(outflow, volume, -1);
    all.add(volume, level,
            std::move(*LinearPlant::make(Plant(Zpk{.K = 1 / problem.area, .zeros = {}, .poles = {0.0}}))));
    const auto blocks = std::make_shared<const BlockDiagram>(all);
    return StructureView{.of = "design",
                         .diagram = std::move(all),
                         .inputs = {{"inflow", volume}},
                         .outputs = {{"level", level}, {"outflow", outflow}},
                         .step = problem.step,
                         .curves = {sensitivity_at("loop", blocks, outflow, {})}};
}

}  // namespace tunewright::structure
