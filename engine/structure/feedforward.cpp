#include "engine/structure/feedforward.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "engine/blocks/diagram_response.h"
#include "engine/blocks/diagram_stability.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/structure/drawing/view.h"
#include "engine/structure/loop_design.h"

namespace tunewright::structure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSlopeOfRule = 1.7;               // Guzman and Hagglund: a over the change of Tp
constexpr double kFirstSteps[] = {0.1, 0.3, 0.5};  // of ln(Kf), ln(Tz), ln(Tp)
constexpr int kMostEvaluations = 160;              // of each of the searches
constexpr double kShortLag = 0.05;                 // of the lead: a start whose first move is large
constexpr double kSameMove = 1 + 1e-9;             // of the bound: rounding
constexpr double kExact = 1e-6;                    // of the IAE or the peak without feedforward
constexpr double kNearZero = 1e-5;                 // of 1/time: where transforms are taken for 0

struct Diagram {
    BlockDiagram blocks;
    int d = 0, y = 0, u = 0;
};

Expected<Diagram> diagram_of(const LinearPlant& plant, const LinearPlant& disturbance, const IdealPid& feedback,
                             const std::optional<Feedforward>& f) {
    Diagram out;
    out.d = out.blocks.add_signal();
    out.y = out.blocks.add_signal();
    const auto loop = add_pid(out.blocks, to_parallel(feedback), out.y);
    if (!loop) return loop.error();
    out.u = loop->output;
    add_row(out.blocks, {{out.u, &plant}, {out.d, &disturbance}}, out.y);
    if (!f || f->Kf == 0) return out;
    if (f->Tp > 0)
        out.blocks.add(out.d, out.u,
                       std::move(*LinearPlant::make(
                           Plant(TransferFunction{.num = {-f->Kf * f->Tz, -f->Kf}, .den = {f->Tp, 1}, .L = f->Lf}))));
    else
        out.blocks.add(out.d, out.u, -f->Kf, f->Lf);
    return out;
}

double IAE_of(const FeedforwardProblem& problem, const Feedforward& f) {
    const auto diagram = diagram_of(problem.plant, problem.disturbance, problem.feedback, f);
    return diagram ? quick_IAE(diagram->blocks, diagram->d, diagram->y, 0) : kInfinity;
}

std::vector<Figure> IAE_if_wrong(const FeedforwardProblem& problem, const Feedforward& f) {
    std::vector<Figure> out;
    for (const double factor : {1 - problem.wrong, 1 + problem.wrong}) {
        FeedforwardProblem other = problem;
        other.disturbance = changed(problem.disturbance, factor, 1);
        out.push_back(finite_or(IAE_of(other, f), kRestsElsewhere));
    }
    for (const double factor : {1 - problem.wrong, 1 + problem.wrong}) {
        FeedforwardProblem other = problem;
        other.plant = changed(problem.plant, 1, factor);
        const auto loop = diagram_of(other.plant, other.disturbance, other.feedback, {});
        out.push_back(loop && count_unstable_poles(loop->blocks).stable()
                          ? finite_or(IAE_of(other, f), kRestsElsewhere)
                          : no_figure("With this dead time the loop is not stable."));
    }
    return out;
}

/// The disturbance's own response until the valve can act.
double unavoidable_peak(const FeedforwardProblem& problem, double late) {
    if (late <= 0) return 0;
    BlockDiagram alone;
    const int d = alone.add_signal(), y = alone.add_signal();
    alone.add(d, y, problem.disturbance);
    const auto response = DiagramResponse::of(alone, {{d, 1}}, {.horizon = problem.plant.dead_time()});
    if (!response) return 0;
    double most = 0;
    for (const ResponseNode& node : response->pair(y, y, 0).nodes) most = std::max(most, std::abs(node.y));
    return most;
}

/// Lead, lag and delay of the two plants by their sums of lags.
Feedforward inverse_of(const FeedforwardProblem& problem) {
    return {.Kf = problem.disturbance.low_frequency_gain() / problem.plant.low_frequency_gain(),
            .Tz = problem.plant.lag_sum(),
            .Tp = problem.disturbance.lag_sum(),
            .Lf = std::max(0.0, problem.disturbance.dead_time() - problem.plant.dead_time())};
}

/// Integral of what Pd d - P F d leaves open after a unit step of d, with the static gain exact.
double open_integral(const FeedforwardProblem& problem, const Feedforward& f) {
    const double scale = std::max({problem.plant.time_scale(), problem.disturbance.time_scale(), f.Tz, f.Tp, f.Lf});
    const auto residual = [&](double s) {
        const std::complex<double> at(s);
        const double F = f.Kf * (f.Tz * s + 1) / (f.Tp * s + 1) * std::exp(-f.Lf * s);
        return (problem.disturbance.at(at) - problem.plant.at(at) * F).real() / s;
    };
    const double h = kNearZero / scale;
    return 2 * residual(h) - residual(2 * h);
}

Feedforward rule_of(const FeedforwardProblem& problem, double late) {
    Feedforward f = inverse_of(problem);
    const double Td = f.Tp;
    if (late > 0) f.Tp = late < kSlopeOfRule * Td ? Td - late / kSlopeOfRule : 0;
    if (f.Tp <= std::abs(f.Kf) * f.Tz / problem.jump) f.Tp = std::abs(f.Kf) * f.Tz / problem.jump;
    if (problem.feedback.has_integral()) f.Kf -= problem.feedback.Kp / problem.feedback.Ti * open_integral(problem, f);
    return f;
}

/// The least IAE over gain, lead and lag. A lag that would move u too far at first is lengthened to the bound. Without
/// integral action in the feedback only the static gain brings y to rest at its target.
Feedforward optimum_of(const FeedforwardProblem& problem, const Feedforward& rule, const RunControl& control,
                       bool& stopped) {
    const Feedforward inverse = inverse_of(problem);
    const auto at = [&](const std::vector<double>& x) {
        Feedforward f{.Kf = problem.feedback.has_integral() ? std::copysign(std::exp(x[0]), inverse.Kf) : inverse.Kf,
                      .Tz = std::exp(x[1]),
                      .Tp = std::exp(x[2]),
                      .Lf = inverse.Lf};
        f.Tp = std::max(f.Tp, std::abs(f.Kf) * f.Tz / problem.jump);
        return f;
    };
    const double time = std::max({inverse.Tz, inverse.Tp, 1e-3 * problem.plant.time_scale()});
    const auto start_of = [&](const Feedforward& f) {
        return std::vector<double>{std::log(std::abs(f.Kf)), std::log(std::max(f.Tz, 1e-3 * time)),
                                   std::log(std::max(f.Tp, 1e-3 * time))};
    };
    Feedforward quick = inverse;
    quick.Tp = std::max(kShortLag * quick.Tz, 1e-3 * time);
    Feedforward brief = quick;  // of equal lags the inverse is a gain: what helps is a pulse as long as the lateness
    brief.Tz = std::max(problem.plant.dead_time() - problem.disturbance.dead_time(), 1e-3 * time);
    brief.Tp = kShortLag * brief.Tz;
    Feedforward best = inverse;
    double least = kInfinity;
    const double none = IAE_of(problem, {}), floor = std::isfinite(none) ? 1e-12 * none : 0;
    for (const Feedforward& start : {rule, inverse, quick, brief}) {
        const auto found = find_local_minimum(LocalSearch::nelder_mead,
                                              [&](const std::vector<double>& x, bool& stop) {
                                                  stop = stopped = control.stop.stop_requested();
                                                  const double IAE = IAE_of(problem, at(x));
                                                  return std::isfinite(IAE) ? std::log(IAE + floor) : 100.0;
                                              },
                                              start_of(start),
                                              {.step = {kFirstSteps[0], kFirstSteps[1], kFirstSteps[2]},
                                               .tolerance = 1e-5,
                                               .max_evaluations = kMostEvaluations});
        if (found.value < least) {
            least = found.value;
            best = at(found.x);
        }
        if (stopped) break;
    }
    return best;
}

std::optional<Error> refused(const FeedforwardProblem& problem) {
    if (problem.plant.integrators() != problem.disturbance.integrators())
        return Error{ErrorKind::invalid_argument, "disturbance",
                     "Plant and disturbance differ in their integrators: no finite gain of the feedforward holds the "
                     "measurement. Give both with the same number of integrators."};
    if (problem.disturbance.unstable_poles() > 0)
        return Error{ErrorKind::unsupported, "disturbance",
                     "The path of the disturbance is not stable by itself, and no controller of u changes that. Give a "
                     "stable path, or one that integrates as the plant does."};
    if (!(problem.jump > 0))
        return Error{ErrorKind::invalid_argument, "jump", "The largest first move of u must be above 0."};
    const auto loop = diagram_of(problem.plant, problem.disturbance, problem.feedback, {});
    if (!loop) return loop.error();
    if (count_unstable_poles(loop->blocks).stable()) return std::nullopt;
    return Error{ErrorKind::invalid_argument, "feedback",
                 "The loop of plant and feedback is not stable, and feedforward cannot change that. Lower the gain."};
}

FeedforwardVariant unbuilt(FeedforwardKind kind, std::string why) {
    FeedforwardVariant out;
    out.kind = kind;
    out.figures.settles = false;
    out.figures.IAE = out.figures.ISE = out.figures.IE = no_figure(why);
    out.why_not = std::move(why);
    return out;
}

}  // namespace

bool is_exact(const StepFigures& with, const StepFigures& without) {
    if (!with.IAE) return false;
    return without.IAE ? *with.IAE <= kExact * *without.IAE : std::abs(with.peak) <= kExact * std::abs(without.peak);
}

const char* name_of(FeedforwardKind kind) {
    constexpr const char* kNames[] = {"none", "static", "inverse", "guzman_hagglund", "optimum", "given"};
    return kNames[std::size_t(kind)];
}

Expected<FeedforwardVariant> judge_feedforward(const FeedforwardProblem& problem,
                                               const std::optional<Feedforward>& compensator) {
    const auto diagram = diagram_of(problem.plant, problem.disturbance, problem.feedback, compensator);
    if (!diagram) return diagram.error();
    auto figures = step_figures(diagram->blocks, diagram->d, diagram->y, diagram->u, 0);
    if (!figures) return figures.error();
    FeedforwardVariant out;
    out.compensator = compensator;
    out.figures = *figures;
    if (compensator) {
        out.u_start = compensator->Lf > 0 ? 0 : -compensator->jump();
        out.IAE_if_wrong = IAE_if_wrong(problem, *compensator);
    }
    return out;
}

Expected<FeedforwardResult> design_feedforward(const FeedforwardProblem& problem, const RunControl& control) {
    if (auto error = refused(problem)) return *error;
    FeedforwardResult out;
    out.late = problem.plant.dead_time() - problem.disturbance.dead_time();
    out.peak_bound = unavoidable_peak(problem, out.late);
    const auto add = [&](FeedforwardKind kind, const std::optional<Feedforward>& f) -> std::optional<Error> {
        auto variant = judge_feedforward(problem, f);
        if (!variant) return variant.error();
        variant->kind = kind;
        out.variants.push_back(std::move(*variant));
        return std::nullopt;
    };
    if (auto error = add(FeedforwardKind::none, {})) return *error;
    if (problem.given) {
        if (auto error = add(FeedforwardKind::given, *problem.given)) return *error;
        return out;
    }
    const Feedforward inverse = inverse_of(problem), rule = rule_of(problem, out.late);
    constexpr const char* kTooFar = "It would move u by more than the allowed first move after a unit step.";
    const auto add_within = [&](FeedforwardKind kind, const Feedforward& f) -> std::optional<Error> {
        const bool proper = f.Tp > 0 || !(f.Tz > 0);
        const bool turned = f.Kf * inverse.Kf <= 0;
        if (proper && !turned && std::abs(f.jump()) <= problem.jump * kSameMove) return add(kind, f);
        out.variants.push_back(
            unbuilt(kind, proper && turned ? "With this limit on the first move its gain would have the wrong sign."
                                           : kTooFar));
        return std::nullopt;
    };
    if (auto error = add_within(FeedforwardKind::gain, Feedforward{.Kf = inverse.Kf})) return *error;
    if (auto error = add_within(FeedforwardKind::inverse, inverse)) return *error;
    if (auto error = add_within(FeedforwardKind::rule, rule)) return *error;
    const bool proper = inverse.Tp > 0 || !(inverse.Tz > 0);
    const bool exact =
        out.late <= 0 && proper && std::abs(inverse.jump()) <= problem.jump &&
        is_exact(out.variants[std::size_t(FeedforwardKind::inverse)].figures, out.variants.front().figures);
    if (auto error = add(FeedforwardKind::optimum, exact ? inverse : optimum_of(problem, rule, control, out.partial)))
        return *error;
    return out;
}

Expected<StructureView> feedforward_view(const FeedforwardProblem& problem, const FeedforwardVariant& variant,
                                         std::optional<double> limit) {
    auto diagram = diagram_of(problem.plant, problem.disturbance, problem.feedback, variant.compensator);
    if (!diagram) return diagram.error();
    const auto blocks = std::make_shared<const BlockDiagram>(diagram->blocks);
    return StructureView{.of = name_of(variant.kind),
                         .diagram = std::move(diagram->blocks),
                         .inputs = {{"disturbance", diagram->d}},
                         .outputs = {{"y", diagram->y}, {"u", diagram->u}},
                         .curves = {sensitivity_at("loop", blocks, diagram->u, limit)}};
}

}  // namespace tunewright::structure
