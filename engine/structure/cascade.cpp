#include "engine/structure/cascade.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <utility>

#include "engine/blocks/diagram_loop.h"
#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/structure/cascade_diagram.h"
#include "engine/structure/search/limited_search.h"
#include "engine/structure/search/local_peaks.h"
#include "engine/structure/search/nearby_stability.h"
#include "engine/structure/step_figures.h"

namespace tunewright::structure {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPerDecade = 40;                 // frequencies of a search
constexpr double kBelow = 1e-2, kAbove = 1e2;  // of the corners of both plants
constexpr double kTurn = 1;                    // rad of a dead time between frequencies of a search
constexpr double kLeastPeak = -0.3;            // ln below a limit: peaks that a step may reach
constexpr double kMostMove = 4;                // ln of a setting from its start
constexpr double kStartAbove = 0.2;            // ln over a limit: of a start
// Of Ms - 1 of the inner loop, where the limits cannot be kept with all of it.
constexpr double kOfInnerPeak[] = {1, 0.93, 0.85, 0.75, 0.6, 0.45, 0.3, 0.2};
constexpr double kWeaker[] = {1, 0.7, 0.45, 0.25, 0.1, 0.03};  // factors of the outer gain until the limits hold

Peaks peaks_at(const BlockDiagram& diagram, int signal) {
    const DiagramLoop loop(diagram, signal);
    return find_peaks(loop, make_peak_grid(loop));
}

/// A PID in logarithms, with the filter of its start's ratio to Td.
class Settings {
public:
    explicit Settings(const IdealPid& start) : start_(start) {}

    Index count() const { return start_.Td > 0 ? 3 : start_.has_integral() ? 2 : 1; }
    VectorXd of_start() const {
        VectorXd x(count());
        x[0] = std::log(std::abs(start_.Kp));
        if (count() > 1) x[1] = std::log(start_.Ti);
        if (count() > 2) x[2] = std::log(start_.Td);
        return x;
    }
    const IdealPid& start() const { return start_; }
    IdealPid at(const Eigen::Ref<const VectorXd>& x) const {
        IdealPid pid = start_;
        pid.Kp = std::copysign(std::exp(x[0]), start_.Kp);
        if (count() > 1) pid.Ti = std::exp(x[1]);
        if (count() > 2) {
            pid.Td = std::exp(x[2]);
            pid.filter.Tf *= pid.Td / start_.Td;
        }
        return pid;
    }

private:
    IdealPid start_;
};

struct Sensitivities {
    Complex inner, outer, valve;
};

/// Without a block diagram: a search needs them at hundreds of frequencies for each of its steps.
Sensitivities sensitivities(const CascadePlants& plants, const ParallelPid& inner, const ParallelPid& outer,
                            double omega) {
    const Complex s(0, omega), P1 = plants.outer.at(s), P2 = plants.inner.at(s);
    // r2 enters behind the filter of y2 and without derivative action.
    const Complex from_r2 = inner.Kp + inner.Ki / s;
    const Complex of_inner = 1.0 + controller_response(inner, s) * P2;
    const Complex of_both = of_inner + controller_response(outer, s) * from_r2 * P1 *
                                           (plants.arrangement == Arrangement::series ? P2 : Complex(1));
    return {1.0 / of_inner, of_inner / of_both, 1.0 / of_both};
}

/// The functions with limits in a search.
enum LimitedFunction { S_outer, S_valve, T_outer, S_inner, kFunctions };

/// One search over the settings of the outer, or of both controllers.
class CascadeSearch {
public:
    CascadeSearch(const CascadePlants& plants, const CascadeDesign& design, const CascadeControllers& start,
                  const RunControl& control)
        : plants_(plants),
          design_(design),
          inner_(start.inner),
          outer_(start.outer),
          grid_(frequencies_around({&plants.inner, &plants.outer}, kBelow, kAbove, kPerDecade, kTurn)),
          control_(control) {}

    LimitedResult outer_only(const VectorXd& start) const { return run(start, false); }
    LimitedResult joint(const VectorXd& start) const { return run(start, true); }

    VectorXd start(bool joint) const {
        if (!joint) return outer_.of_start();
        VectorXd x(outer_.count() + inner_.count());
        x << outer_.of_start(), inner_.of_start();
        return x;
    }

    CascadeControllers controllers(const VectorXd& x) const {
        const Index n = outer_.count();
        return {x.size() > n ? inner_.at(x.tail(x.size() - n)) : inner_.start(), outer_.at(x.head(n))};
    }

    /// ln of the largest excess, infinite if the loops are not stable.
    double excess(const VectorXd& x) const {
        if (!stable(x)) return kInfinity;
        double most = -kInfinity;
        for (const LimitedPeak& peak : peaks(x, false)) most = std::max(most, peak.excess);
        return most;
    }

    double log_cost(const VectorXd& x, bool joint) const {
        const CascadeDiagram all = diagram(x);
        const double outer = quick_IAE(all.diagram, all.outer_input, all.y1, 0);
        if (!joint) return std::log(outer);
        return std::log(design_.weight_outer * outer +
                        design_.weight_inner * quick_IAE(all.diagram, all.valve, all.y1, 0));
    }

private:
    CascadeDiagram diagram(const VectorXd& x) const {
        const CascadeControllers both = controllers(x);
        return std::move(*cascade_diagram(plants_, both.inner, &both.outer));
    }

    bool stable(const VectorXd& x) const {
        const CascadeControllers both = controllers(x);
        const ParallelPid inner = to_parallel(both.inner), outer = to_parallel(both.outer);
        std::vector<Complex> f(grid_.size());
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = 1.0 / sensitivities(plants_, inner, outer, grid_[i]).valve;
        return nearby_.stable(std::move(f), [&] { return count_unstable_poles(diagram(x).diagram).stable(); });
    }

    /// ln of each function over its limit; -infinity for one without a limit in this search.
    std::vector<double> over_limits(const Sensitivities& at, bool joint) const {
        std::vector<double> excess(kFunctions, -kInfinity);
        excess[S_outer] = std::log(std::abs(at.outer) / design_.outer.Ms);
        excess[S_valve] = std::log(std::abs(at.valve) / design_.valve_limit());
        if (joint)
            excess[S_inner] = std::log(std::abs(at.inner) / design_.inner.Ms);
        else
            excess[T_outer] = std::log(std::abs(1.0 - at.outer) / design_.outer.Mt);
        return excess;
    }

    std::vector<LimitedPeak> peaks(const VectorXd& x, bool joint) const {
        const CascadeControllers both = controllers(x);
        const ParallelPid inner = to_parallel(both.inner), outer = to_parallel(both.outer);
        return local_peaks(
            grid_,
            [&](double omega, std::vector<double>& excess) {
                excess = over_limits(sensitivities(plants_, inner, outer, omega), joint);
            },
            kLeastPeak);
    }

    std::vector<double> resolved_excess(const VectorXd& x, bool joint) const {
        const CascadeControllers both = controllers(x);
        const CascadeDiagram all = diagram(x), inner = std::move(*cascade_diagram(plants_, both.inner, nullptr));
        const Peaks of_outer = peaks_at(all.diagram, all.r2), of_valve = peaks_at(all.diagram, all.valve);
        std::vector<double> excess(kFunctions, -kInfinity);
        excess[S_outer] = std::log(of_outer.S.value / design_.outer.Ms);
        excess[S_valve] = std::log(of_valve.S.value / design_.valve_limit());
        if (joint)
            excess[S_inner] = std::log(peaks_at(inner.diagram, inner.valve).S.value / design_.inner.Ms);
        else
            excess[T_outer] = std::log(of_outer.T.value / design_.outer.Mt);
        return excess;
    }

    LimitedResult run(const VectorXd& start, bool joint) const {
        LimitedProblem problem;
        problem.functions = kFunctions;
        problem.stable = [&](const VectorXd& x) { return stable(x); };
        problem.log_cost = [&](const VectorXd& x) { return log_cost(x, joint); };
        problem.peaks = [&](const VectorXd& x) { return peaks(x, joint); };
        problem.excess_at = [&](const VectorXd& x, int function, double omega) {
            const CascadeControllers both = controllers(x);
            return over_limits(sensitivities(plants_, to_parallel(both.inner), to_parallel(both.outer), omega),
                               joint)[std::size_t(function)];
        };
        problem.resolved_excess = [&](const VectorXd& x) { return resolved_excess(x, joint); };
        problem.low = start.array() - kMostMove;
        problem.high = start.array() + kMostMove;
        return search_within_limits(problem, start, {.stop = control_.stop});
    }

    const CascadePlants& plants_;
    const CascadeDesign& design_;
    Settings inner_, outer_;
    std::vector<double> grid_;
    mutable NearbyStability nearby_;
    const RunControl& control_;
};

/// The plant that the outer controller sees, roughly: the closed inner loop as a dead time of its lag.
Expected<LinearPlant> rough_outer_plant(const CascadePlants& plants, const IdealPid& inner) {
    const auto closed = cascade_diagram(plants, inner, nullptr);
    if (!closed) return closed.error();
    const double h = 1e-4 / closed->diagram.time_scale();
    const auto reached = [&](double s) { return closed->diagram.response(s, closed->r2)[closed->outer_input].real(); };
    Zpk plant = factors_of(plants.outer);
    const double ratio = reached(h);
    plant.K *= ratio;
    // Minus the slope of its logarithm at 0: the delay that the inner loop adds.
    const double delay = -std::log(reached(2 * h) / ratio) / h;
    plant.L += std::max(0.0, delay);
    return LinearPlant::make(Plant(plant));
}

/// The place of a loop's error in the request.
Error below(const char* loop, Error error) {
    error.where = loop + (error.where.empty() ? std::string() : "/" + error.where);
    return error;
}

Error unstable_inner() {
    return {
        ErrorKind::invalid_argument, "inner/controller",
        "The inner loop is not stable with this controller, so no outer controller can be designed. Lower its gain, "
        "or leave it out: it is then designed too."};
}

struct FoundCascade {
    CascadeControllers controllers;
    LimitedResult found;  ///< of the outer controller's search

    bool holds() const { return found.excess <= limits::kMaxRelativeExcessFound; }
};

/// The outer controller for an inner one.
Expected<FoundCascade> with_outer(const CascadePlants& plants, const CascadeDesign& design, const IdealPid& inner,
                                  const RunControl& control) {
    const auto closed = cascade_diagram(plants, inner, nullptr);
    if (!closed) return closed.error();
    if (!count_unstable_poles(closed->diagram).stable()) return unstable_inner();
    const auto rough = rough_outer_plant(plants, inner);
    if (!rough) return below("outer", rough.error());
    const auto start = robust_settings(*rough, design.outer, control);
    if (!start) return below("outer", start.error());
    for (const double weaker : kWeaker) {
        IdealPid outer = *start;
        outer.Kp *= weaker;
        const CascadeSearch search(plants, design, {inner, outer}, control);
        if (!(search.excess(search.start(false)) < kStartAbove)) continue;
        const LimitedResult found = search.outer_only(search.start(false));
        return FoundCascade{search.controllers(found.x), found};
    }
    return FoundCascade{{inner, *start}, {}};
}

/// The inner loop, then the outer one. Where no outer controller keeps the limits the inner loop is designed for lower
/// and lower peaks, as long as the cost falls: with a weak outer controller the valve's peak is that of the inner loop.
Expected<FoundCascade> one_after_the_other(const CascadePlants& plants, const CascadeDesign& design,
                                           const RunControl& control) {
    if (design.given_inner) return with_outer(plants, design, *design.given_inner, control);
    LoopDesign wanted = design.inner;
    const double highest = std::min(design.inner.Ms, design.valve_limit());
    Expected<FoundCascade> best = FoundCascade{};
    for (const double share : kOfInnerPeak) {
        if (share < 1) wanted.Ms = 1 + share * (highest - 1);
        const auto inner = robust_settings(plants.inner, wanted, control);
        if (!inner) return best->holds() ? best : below("inner", inner.error());
        auto next = with_outer(plants, design, *inner, control);
        if (!next) return best->holds() ? best : next;
        if (best->holds() && !(next->holds() && next->found.log_cost < best->found.log_cost)) return best;
        best = std::move(next);
        if (best->found.stopped || (share == 1 && best->holds())) return best;
    }
    return best;
}

/// Figures of y1 after unit steps of both loads and the set point.
std::optional<Error> add_responses(const CascadeDiagram& all, LoadFigures& inner_load, LoadFigures& outer_load,
                                   LoadFigures& setpoint) {
    const auto add = [&](int signal, double target, LoadFigures& to) -> std::optional<Error> {
        const auto figures = step_figures(all.diagram, signal, all.y1, all.valve, target);
        if (!figures) return figures.error();
        to = {figures->IAE, figures->IE, target == 0 ? figures->peak : figures->overshoot, figures->TV};
        return std::nullopt;
    };
    if (auto error = add(all.valve, 0, inner_load)) return error;
    if (auto error = add(all.outer_input, 0, outer_load)) return error;
    return add(all.r1, 1, setpoint);
}

}  // namespace

double default_valve_limit(double Ms_inner, double Ms_outer) {
    return kDefaultValveOverLoops * std::max(Ms_inner, Ms_outer);
}

double CascadeDesign::valve_limit() const { return Ms_valve.value_or(default_valve_limit(inner.Ms, outer.Ms)); }

Expected<CascadeFigures> judge_cascade(const CascadePlants& plants, const CascadeControllers& controllers) {
    const auto all = cascade_diagram(plants, controllers.inner, &controllers.outer);
    if (!all) return all.error();
    const auto inner = cascade_diagram(plants, controllers.inner, nullptr);
    CascadeFigures out;
    out.stable = count_unstable_poles(all->diagram).stable() && count_unstable_poles(inner->diagram).stable();
    out.speed_ratio = no_figure("The loops are not stable.");
    if (!out.stable) return out;
    const DiagramLoop own(inner->diagram, inner->valve), outer(all->diagram, all->r2);
    const LoopGrid own_grid = make_peak_grid(own), grid = make_peak_grid(outer);
    const Peaks of_inner = find_peaks(own, own_grid), of_outer = find_peaks(outer, grid),
                of_valve = peaks_at(all->diagram, all->valve);
    out.Ms_inner = of_inner.S.value;
    out.Mt_inner = of_inner.T.value;
    out.Ms_outer = of_outer.S.value;
    out.Mt_outer = of_outer.T.value;
    out.Ms_valve = of_valve.S.value;
    out.outer_margins = find_margins(outer, grid);
    const double fast = find_margins(own, own_grid).gain_crossover, slow = out.outer_margins.gain_crossover;
    out.speed_ratio = fast > 0 && slow > 0 ? Figure(fast / slow) : no_figure("A loop has no gain crossover.");
    if (auto error = add_responses(*all, out.inner_load, out.outer_load, out.setpoint)) return *error;
    return out;
}

Expected<CascadeResult> design_cascade(const CascadePlants& plants, const CascadeDesign& design,
                                       const RunControl& control) {
    auto pair = one_after_the_other(plants, design, control);
    if (!pair) return pair.error();
    LimitedResult found = pair->found;
    if (!pair->holds() && control.stop.stop_requested())
        return Error{ErrorKind::cancelled, "", "The search was stopped before it found settings."};
    if (!pair->holds())
        return Error{
            ErrorKind::no_feasible_controller, "limits",
            design.given_inner
                ? "No outer controller keeps the limits with this inner one; allow a larger Ms, or give an "
                  "inner controller of lower gain."
                : "No outer controller keeps the limits, not even with a weaker inner one; allow a larger Ms."};
    CascadeResult result;
    result.controllers = pair->controllers;
    if (design.joint && !found.stopped) {
        const CascadeSearch search(plants, design, result.controllers, control);
        const VectorXd start = search.start(true);
        const LimitedResult both = search.joint(start);
        if (both.excess <= limits::kMaxRelativeExcessFound && both.log_cost < search.log_cost(start, true)) {
            found = both;
            result.controllers = search.controllers(both.x);
        }
    }
    result.partial = found.stopped;
    auto figures = judge_cascade(plants, result.controllers);
    if (!figures) return figures.error();
    result.figures = *figures;
    return result;
}

Expected<SingleLoop> design_single_loop(const CascadePlants& plants, const LoopDesign& design,
                                        const RunControl& control) {
    const auto whole = plants.arrangement == Arrangement::series
                           ? LinearPlant::make(Plant(factors_of(plants.inner, plants.outer)))
                           : Expected<LinearPlant>(plants.outer);
    if (!whole) return whole.error();
    auto controller = robust_settings(*whole, design, control);
    if (!controller) return controller.error();
    SingleLoop out{.controller = *controller, .inner_load = {}, .outer_load = {}, .setpoint = {}};
    const auto all = single_diagram(plants, out.controller);
    if (!all) return all.error();
    out.stable = count_unstable_poles(all->diagram).stable();
    if (!out.stable) return out;
    const Peaks peaks = peaks_at(all->diagram, all->valve);
    out.Ms = peaks.S.value;
    out.Mt = peaks.T.value;
    if (auto error = add_responses(*all, out.inner_load, out.outer_load, out.setpoint)) return *error;
    return out;
}

}  // namespace tunewright::structure
