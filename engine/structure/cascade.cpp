#include "engine/structure/cascade.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/blocks/diagram_loop.h"
#include "engine/loop/peaks.h"
#include "engine/structure/limited_search.h"
#include "engine/structure/local_peaks.h"
#include "engine/structure/step_figures.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kValveOverLoops = 1.15;  // the default limit on Ms_valve
constexpr int kPerDecade = 40;            // frequencies of a search
constexpr double kLeastPeak = -0.3;       // ln below a limit: peaks that a step may reach
constexpr double kMostMove = 4;           // ln of a setting from its start
constexpr double kWeaker[] = {1, 0.7, 0.45, 0.25, 0.1, 0.03};  // factors of the outer gain until the limits hold

double valve_limit(const CascadeLimits& limits) {
    return limits.Ms_valve.value_or(kValveOverLoops * std::max(limits.Ms_inner, limits.Ms_outer));
}

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

/// Frequencies from far below to far above both loops.
std::vector<double> search_grid(const CascadePlants& plants) {
    double low = kInfinity, high = 0;
    for (const LinearPlant* plant : {&plants.inner, &plants.outer}) {
        const auto add = [&](double omega) {
            if (!(omega > 0) || !std::isfinite(omega)) return;
            low = std::min(low, omega);
            high = std::max(high, omega);
        };
        add(1 / plant->time_scale());
        for (const auto pole : plant->poles()) add(std::abs(pole));
        if (plant->dead_time() > 0) add(1 / plant->dead_time());
    }
    if (!(high > 0)) low = high = 1;
    return logarithmic(low * 1e-2, high * 1e2, kPerDecade);
}

/// ln of the functions over their limits: S and T of the outer loop, S at the valve, S of the inner loop.
void excess_of(const CascadeDiagram& all, const CascadeDiagram& inner, const CascadeLimits& limits, bool sequential,
               double omega, std::vector<double>& excess) {
    const std::complex<double> s(0, omega);
    const auto outer = all.diagram.response(s, all.r2)[all.r2], valve = all.diagram.response(s, all.valve)[all.valve];
    excess = {std::log(std::abs(outer) / limits.Ms_outer), std::log(std::abs(valve) / valve_limit(limits))};
    if (sequential)
        excess.push_back(std::log(std::abs(1.0 - outer) / limits.Mt_outer));
    else
        excess.push_back(std::log(std::abs(inner.diagram.response(s, inner.valve)[inner.valve]) / limits.Ms_inner));
}

/// One search over the settings of the outer, or of both controllers.
class CascadeSearch {
public:
    CascadeSearch(const CascadePlants& plants, const CascadeDesign& design, const CascadeControllers& start,
                  const RunControl& control)
        : plants_(plants), design_(design), inner_(start.inner), outer_(start.outer), grid_(search_grid(plants)),
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
        return {x.size() > n ? inner_.at(x.tail(x.size() - n)) : inner_.at(inner_.of_start()), outer_.at(x.head(n))};
    }

    /// ln of the largest excess, infinite if the loops are not stable.
    double excess(const VectorXd& x) const {
        if (!std::isfinite(log_cost(x, false))) return kInfinity;
        double most = -kInfinity;
        for (const LimitedPeak& peak : peaks(x, false)) most = std::max(most, peak.excess);
        return most;
    }

private:
    struct Diagrams {
        CascadeDiagram all, inner;
    };
    Diagrams diagrams(const VectorXd& x) const {
        const CascadeControllers both = controllers(x);
        return {std::move(*cascade_diagram(plants_, both.inner, &both.outer)),
                std::move(*cascade_diagram(plants_, both.inner, nullptr))};
    }

    double log_cost(const VectorXd& x, bool joint) const {
        const CascadeDiagram all = std::move(diagrams(x).all);
        if (!count_unstable_poles(all.diagram).stable()) return kInfinity;
        const double outer = quick_IAE(all.diagram, all.outer_input, all.y1, 0);
        if (!joint) return std::log(outer);
        return std::log(design_.weight_outer * outer +
                        design_.weight_inner * quick_IAE(all.diagram, all.valve, all.y1, 0));
    }

    std::vector<LimitedPeak> peaks(const VectorXd& x, bool joint) const {
        const Diagrams both = diagrams(x);
        return local_peaks(
            grid_,
            [&](double omega, std::vector<double>& excess) {
                excess_of(both.all, both.inner, design_.limits, !joint, omega, excess);
            },
            kLeastPeak);
    }

    LimitedResult run(const VectorXd& start, bool joint) const {
        LimitedProblem problem;
        problem.log_cost = [&](const VectorXd& x) { return log_cost(x, joint); };
        problem.peaks = [&](const VectorXd& x) { return peaks(x, joint); };
        problem.excess_at = [&](const VectorXd& x, int function, double omega) {
            const Diagrams both = diagrams(x);
            std::vector<double> excess;
            excess_of(both.all, both.inner, design_.limits, !joint, omega, excess);
            return excess[std::size_t(function)];
        };
        problem.low = start.array() - kMostMove;
        problem.high = start.array() + kMostMove;
        return search_within_limits(problem, start, {.stop = control_.stop});
    }

    const CascadePlants& plants_;
    const CascadeDesign& design_;
    Settings inner_, outer_;
    std::vector<double> grid_;
    const RunControl& control_;
};

/// The plant that the outer controller sees, roughly: the closed inner loop as a dead time of its lag.
Expected<LinearPlant> rough_outer_plant(const CascadePlants& plants, const IdealPid& inner) {
    const auto closed = cascade_diagram(plants, inner, nullptr);
    if (!closed) return closed.error();
    const double h = 1e-4 / closed->diagram.time_scale();
    const auto to_y1 = [&](double s) { return closed->diagram.response(s, closed->r2)[closed->y1].real(); };
    Zpk plant{.K = plants.outer.gain(),
              .zeros = {plants.outer.zeros().begin(), plants.outer.zeros().end()},
              .poles = {plants.outer.poles().begin(), plants.outer.poles().end()},
              .L = plants.outer.dead_time()};
    for (int i = 0; i < plants.outer.integrators(); ++i) plant.poles.emplace_back(0);
    const double ratio = to_y1(h) / plants.outer.at(h).real();
    plant.K *= ratio;
    // -d ln(to_y1/P1)/ds at 0: the delay that the inner loop adds.
    const double delay = -std::log(to_y1(2 * h) / plants.outer.at(2 * h).real() / ratio) / h;
    plant.L += std::max(0.0, delay);
    return LinearPlant::make(Plant(plant));
}

Expected<IdealPid> robust_settings(const LinearPlant& plant, ControllerKind kind, double Ms, double Mt,
                                   const RunControl& control) {
    const Zpk as_given{.K = plant.gain(),
                       .zeros = {plant.zeros().begin(), plant.zeros().end()},
                       .poles = {plant.poles().begin(), plant.poles().end()},
                       .L = plant.dead_time()};
    TuningProblem problem{.plant = Plant(as_given), .linear = plant, .dead_time_std = {}};
    auto tuned = tune_robust(problem, {.controller = kind, .Ms = Ms, .Mt = Mt}, {control.stop, nullptr, control.now_ms});
    if (!tuned) return tuned.error();
    return tuned->controller;
}

CascadeControllers sequential(const CascadePlants& plants, const CascadeDesign& design, CascadeControllers start,
                              const RunControl& control, LimitedResult& best) {
    for (const double weaker : kWeaker) {
        IdealPid outer = start.outer;
        outer.Kp *= weaker;
        const CascadeSearch search(plants, design, {start.inner, outer}, control);
        if (!(search.excess(search.start(false)) < 0.2)) continue;
        best = search.outer_only(search.start(false));
        return search.controllers(best.x);
    }
    return start;
}

}  // namespace

Expected<CascadeDiagram> cascade_diagram(const CascadePlants& plants, const IdealPid& inner, const IdealPid* outer) {
    CascadeDiagram out;
    BlockDiagram& diagram = out.diagram;
    out.y1 = diagram.add_signal();
    out.y2 = diagram.add_signal();
    out.outer_input = diagram.add_signal();
    const auto second = add_pid(diagram, to_parallel(inner), out.y2);
    if (!second) return second.error();
    out.valve = second->output;
    out.r2 = second->error;
    diagram.add(out.valve, out.y2, plants.inner);
    diagram.add(plants.arrangement == Arrangement::series ? out.y2 : out.valve, out.outer_input, 1);
    diagram.add(out.outer_input, out.y1, plants.outer);
    if (outer == nullptr) return out;
    const auto first = add_pid(diagram, to_parallel(*outer), out.y1);
    if (!first) return first.error();
    out.r1 = first->error;
    out.r2 = first->output;
    diagram.add(first->output, second->error, 1);
    return out;
}

Expected<CascadeFigures> judge_cascade(const CascadePlants& plants, const CascadeControllers& controllers) {
    const auto all = cascade_diagram(plants, controllers.inner, &controllers.outer);
    if (!all) return all.error();
    const auto inner = cascade_diagram(plants, controllers.inner, nullptr);
    CascadeFigures out;
    out.stable = count_unstable_poles(all->diagram).stable() && count_unstable_poles(inner->diagram).stable();
    if (!out.stable) return out;
    const Peaks of_inner = peaks_at(inner->diagram, inner->valve), of_valve = peaks_at(all->diagram, all->valve);
    const DiagramLoop outer(all->diagram, all->r2);
    const LoopGrid grid = make_peak_grid(outer);
    const Peaks of_outer = find_peaks(outer, grid);
    out.Ms_inner = of_inner.S.value;
    out.Mt_inner = of_inner.T.value;
    out.Ms_outer = of_outer.S.value;
    out.Mt_outer = of_outer.T.value;
    out.Ms_valve = of_valve.S.value;
    out.outer_margins = find_margins(outer, grid);
    const auto add = [&](int signal, double target, LoadFigures& to) -> std::optional<Error> {
        const auto figures = step_figures(all->diagram, signal, all->y1, all->valve, target);
        if (!figures) return figures.error();
        to = {figures->IAE, figures->IE, figures->peak, figures->TV};
        if (target != 0) out.overshoot_percent = 100 * figures->overshoot;
        return std::nullopt;
    };
    if (auto error = add(all->valve, 0, out.inner_load)) return *error;
    if (auto error = add(all->outer_input, 0, out.outer_load)) return *error;
    if (auto error = add(all->r1, 1, out.setpoint)) return *error;
    return out;
}

Expected<CascadeResult> design_cascade(const CascadePlants& plants, const CascadeDesign& design,
                                       const RunControl& control) {
    const CascadeLimits& limits = design.limits;
    auto inner = robust_settings(plants.inner, design.inner, limits.Ms_inner, limits.Mt_inner, control);
    if (!inner) return inner.error();
    const auto rough = rough_outer_plant(plants, *inner);
    if (!rough) return rough.error();
    auto outer = robust_settings(*rough, design.outer, limits.Ms_outer, limits.Mt_outer, control);
    if (!outer) return outer.error();
    CascadeResult result;
    LimitedResult found;
    result.controllers = sequential(plants, design, {*inner, *outer}, control, found);
    if (!std::isfinite(found.log_cost))
        return Error{ErrorKind::no_feasible_controller, "limits",
                     "No outer controller keeps the limits with this inner one; allow a larger Ms, or a slower inner loop."};
    if (design.joint && !found.stopped) {
        const CascadeSearch search(plants, design, result.controllers, control);
        const LimitedResult both = search.joint(search.start(true));
        if (std::isfinite(both.log_cost) && both.excess <= limits::kMaxRelativeExcessFound) {
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

}  // namespace tunewright::structure
