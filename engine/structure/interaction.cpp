#include "engine/structure/interaction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "engine/blocks/diagram_loop.h"
#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/structure/decoupling/decoupler_blocks.h"
#include "engine/structure/drawing/view.h"
#include "engine/structure/interaction_gains.h"
#include "engine/structure/loop_design.h"
#include "engine/structure/search/limited_search.h"
#include "engine/structure/search/local_peaks.h"
#include "engine/structure/step_figures.h"
#include "engine/structure/structured_peak.h"
#include "engine/tuning/limits.h"

namespace tunewright::structure {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBelow = 1e-3, kAbove = 1e2;                 // of the corners
constexpr double kLeastPeak = -0.3;                           // ln below a limit
constexpr double kMostMove = 5;                               // ln of a setting from its start
constexpr double kUltimateOverKp = 2.2, kPeriodOverTi = 1.2;  // Luyben 1986
constexpr double kDecibels = 2;                               // of the log modulus, for each loop
constexpr double kLeastF = 0.3, kMostF = 1000, kOfF = 1e-12;  // the last: relative, where the bisection ends
constexpr double kWeaker[] = {1, 0.7, 0.5, 0.35, 0.25, 0.15, 0.08};
constexpr double kStartAbove = 1.2;  // mu of a start over its limit
constexpr double kFaster = 3;        // factor of a start with one loop quick and the other slow
constexpr double kTf_over_Td = 0.1;
constexpr int kFirstIterations = 8;   // of every start, before the hopeless ones are dropped
constexpr double kHopeless = 0.3;     // ln of cost behind the best start then
constexpr double kSameValley = 0.02;  // ln of every setting between two starts then

/// The plants behind their decoupler, if there is one.
struct DecoupledPlants {
    const PlantMatrix& plants;
    const Decoupling& decoupling;

    std::size_t size() const { return plants.size(); }
    unsigned all_loops() const { return (1u << size()) - 1; }
};

/// The loops of `closed`, of those there are.
struct LoopsDiagram {
    BlockDiagram blocks;
    std::vector<int> y, u, r;  ///< r: the controller's error; -1 for a loop in manual
    std::vector<int> load;     ///< where loads enter: u, or what the decoupler does not see
};

/// Plants of loops in manual are outside every loop and left out: their integrators and unstable poles are not the
/// loops'.
Expected<LoopsDiagram> diagram_of(const DecoupledPlants& loops, const std::vector<IdealPid>& controllers,
                                  unsigned closed) {
    LoopsDiagram out;
    const PlantMatrix& plants = loops.plants;
    const std::size_t n = plants.size();
    const auto is_closed = [closed](std::size_t i) { return ((closed >> i) & 1u) != 0; };
    for (std::size_t i = 0; i < n; ++i) out.y.push_back(out.blocks.add_signal());
    for (std::size_t i = 0; i < n; ++i) {
        if (!is_closed(i)) {
            out.u.push_back(out.blocks.add_signal());
            out.r.push_back(-1);
            continue;
        }
        const auto pid = add_pid(out.blocks, to_parallel(controllers[i]), out.y[i]);
        if (!pid) return Error{pid.error().kind, "controllers/" + std::to_string(i), pid.error().message};
        out.u.push_back(pid->output);
        out.r.push_back(pid->error);
    }
    if (!loops.decoupling.empty()) {
        const std::vector<int> from = out.u;
        for (int& u : out.u) u = out.blocks.add_signal();
        add_decoupler(out.blocks, loops.decoupling, closed, from, out.u);
    }
    for (const int u : out.u) {
        out.load.push_back(loops.decoupling.empty() ? u : out.blocks.add_signal());
        if (!loops.decoupling.empty()) out.blocks.add(u, out.load.back(), 1);
    }
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<std::pair<int, const LinearPlant*>> row;
        for (std::size_t j = 0; j < n; ++j)
            if (plants[i][j] && is_closed(i) && is_closed(j)) row.emplace_back(out.load[j], &*plants[i][j]);
        add_row(out.blocks, row, out.y[i]);
    }
    return out;
}

/// P(j omega) D(j omega), computed once at the frequencies of a grid, which a search visits again and again.
class PlantResponses {
public:
    PlantResponses(const DecoupledPlants& loops, std::vector<double> grid) : loops_(loops), omega_(std::move(grid)) {
        for (const double omega : omega_) on_grid_.push_back(computed(omega));
    }

    const std::vector<double>& grid() const { return omega_; }

    LoopMatrix at(double omega) const {
        const auto found = std::ranges::lower_bound(omega_, omega);
        return found != omega_.end() && *found == omega ? on_grid_[std::size_t(found - omega_.begin())]
                                                        : computed(omega);
    }

private:
    LoopMatrix computed(double omega) const {
        const auto n = Index(loops_.size());
        LoopMatrix out = LoopMatrix::Zero(n, n);
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j)
                if (const auto& plant = loops_.plants[std::size_t(i)][std::size_t(j)])
                    out(i, j) = plant->at(Complex(0, omega));
        if (!loops_.decoupling.empty()) out *= decoupler_response(loops_.decoupling, Complex(0, omega));
        return out;
    }

    const DecoupledPlants loops_;
    std::vector<double> omega_;
    std::vector<LoopMatrix> on_grid_;
};

/// The sensitivity at the outputs: what enters at y_j, seen at y_i.
LoopMatrix sensitivity(const PlantResponses& plants, const std::vector<ParallelPid>& controllers, double omega) {
    LoopMatrix A = plants.at(omega);
    for (Index j = 0; j < A.cols(); ++j)
        A.col(j) *= controller_response(controllers[std::size_t(j)], Complex(0, omega));
    A.diagonal().array() += 1;
    return A.inverse();
}

std::vector<ParallelPid> parallel(const std::vector<IdealPid>& controllers) {
    std::vector<ParallelPid> out;
    for (const IdealPid& one : controllers) out.push_back(to_parallel(one));
    return out;
}

struct Fineness {
    int per_decade;
    double turn;  // rad of the largest dead time between neighbours
};
constexpr Fineness kSearched{30, 0.7}, kJudged{200, 0.2};

std::vector<double> grid_of(const DecoupledPlants& loops, const Fineness& fineness) {
    std::vector<const LinearPlant*> paths;
    for (const auto& row : loops.plants)
        for (const auto& plant : row)
            if (plant) paths.push_back(&*plant);
    // The decoupler's sums turn once around its own loop.
    double delay = 0;
    for (const auto& row : loops.decoupling)
        for (const auto& element : row)
            if (element) delay += element->Lf;
    const LinearPlant around = *LinearPlant::make(Plant(Fopdt{.K = 1, .T = 0, .L = delay}));
    if (delay > 0) paths.push_back(&around);
    return frequencies_around(paths, kBelow, kAbove, fineness.per_decade, fineness.turn);
}

/// 1 where no peak is above `least`.
Peak mu_peak(const PlantResponses& plants, const std::vector<IdealPid>& controllers, double least) {
    const auto gains = parallel(controllers);
    const auto peaks = local_peaks(
        plants.grid(),
        [&, value = StructuredValues(least)](double omega, std::vector<double>& excess) mutable {
            excess = {std::log(value(sensitivity(plants, gains, omega)))};
        },
        std::log(least));
    Peak best{1, kInfinity};
    for (const LimitedPeak& peak : peaks)
        if (std::exp(peak.excess) > best.value) best = {std::exp(peak.excess), peak.omega};
    return best;
}

/// Lower peaks are not looked at where the highest one may be `mu`.
double least_of(double mu) { return std::exp(kLeastPeak) * mu; }

/// 20 log10 of max |W/(1 + W)|, W = det(I + P C) - 1: 1/(1 + W) is the determinant of S.
double log_modulus(const PlantResponses& plants, const std::vector<IdealPid>& controllers) {
    const auto gains = parallel(controllers);
    double most = -kInfinity;
    const auto peaks = local_peaks(
        plants.grid(),
        [&](double omega, std::vector<double>& excess) {
            excess = {std::log(std::abs(1.0 - sensitivity(plants, gains, omega).determinant()))};
        },
        -2);
    for (const LimitedPeak& peak : peaks) most = std::max(most, peak.excess);
    return 20 * most / std::numbers::ln10;
}

bool stable_with(const DecoupledPlants& loops, const std::vector<IdealPid>& controllers, unsigned closed) {
    const auto diagram = diagram_of(loops, controllers, closed);
    if (!diagram) return false;
    return count_unstable_poles(diagram->blocks).stable();
}

/// Settings in logarithms, with the signs and filters of a start.
class Settings {
public:
    explicit Settings(std::vector<IdealPid> start) : start_(std::move(start)) {}

    VectorXd of_start() const {
        VectorXd x(per_loop() * Index(start_.size()));
        for (std::size_t i = 0; i < start_.size(); ++i) {
            const Index at = per_loop() * Index(i);
            x[at] = std::log(std::abs(start_[i].Kp));
            x[at + 1] = std::log(start_[i].Ti);
            if (per_loop() > 2) x[at + 2] = std::log(start_[i].Td);
        }
        return x;
    }
    std::vector<IdealPid> at(const VectorXd& x) const {
        std::vector<IdealPid> out(start_);
        for (std::size_t i = 0; i < out.size(); ++i) {
            const Index at = per_loop() * Index(i);
            out[i].Kp = std::copysign(std::exp(x[at]), start_[i].Kp);
            out[i].Ti = std::exp(x[at + 1]);
            if (per_loop() < 3) continue;
            out[i].Td = std::exp(x[at + 2]);
            out[i].filter.Tf = kTf_over_Td * out[i].Td;
        }
        return out;
    }

private:
    Index per_loop() const { return start_.front().Td > 0 ? 3 : 2; }
    std::vector<IdealPid> start_;
};

/// Those of every search of one problem.
struct Grids {
    PlantResponses searched, judged;

    explicit Grids(const DecoupledPlants& loops)
        : searched(loops, grid_of(loops, kSearched)), judged(loops, grid_of(loops, kJudged)) {}
};

class InteractionSearch {
public:
    InteractionSearch(const DecoupledPlants& loops, const Grids& grids, const InteractionDesign& design,
                      const std::vector<IdealPid>& start)
        : loops_(&loops), grids_(&grids), design_(&design), settings_(start) {}

    LimitedResult run(const VectorXd& from, const LimitedOptions& options) const {
        LimitedProblem problem;
        problem.stable = [&](const VectorXd& x) { return all_subsets_stable(settings_.at(x)); };
        problem.log_cost = [&](const VectorXd& x) { return log_cost(settings_.at(x)); };
        problem.peaks = [&](const VectorXd& x) {
            const auto gains = parallel(settings_.at(x));
            return local_peaks(
                grids_->searched.grid(),
                [&, value = StructuredValues(least_of(design_->mu))](double omega,
                                                                     std::vector<double>& excess) mutable {
                    excess = {std::log(value(sensitivity(grids_->searched, gains, omega)) / design_->mu)};
                },
                kLeastPeak);
        };
        problem.excess_at = [&](const VectorXd& x, int, double omega) {
            return excess_at(parallel(settings_.at(x)), omega);
        };
        problem.resolved_excess = [&](const VectorXd& x) {
            return std::vector{
                std::log(mu_peak(grids_->judged, settings_.at(x), least_of(design_->mu)).value / design_->mu)};
        };
        problem.low = start().array() - kMostMove;
        problem.high = start().array() + kMostMove;
        return search_within_limits(problem, from, options);
    }

    VectorXd start() const { return settings_.of_start(); }

    std::vector<IdealPid> controllers(const VectorXd& x) const { return settings_.at(x); }

private:
    double excess_at(const std::vector<ParallelPid>& gains, double omega) const {
        return std::log(structured_value(sensitivity(grids_->searched, gains, omega)) / design_->mu);
    }

    bool all_subsets_stable(const std::vector<IdealPid>& controllers) const {
        for (unsigned closed = loops_->all_loops(); closed > 0; --closed)
            if (!stable_with(*loops_, controllers, closed)) return false;
        return true;
    }

    double log_cost(const std::vector<IdealPid>& controllers) const {
        const auto diagram = diagram_of(*loops_, controllers, loops_->all_loops());
        double sum = 0;
        for (const int load : diagram->load) sum += weighted_IAE(diagram->blocks, load, diagram->y);
        return std::log(sum);
    }

    double weighted_IAE(const BlockDiagram& blocks, int load, const std::vector<int>& outputs) const {
        double sum = 0;
        const std::vector<double> IAE = quick_IAEs(blocks, load, outputs);
        for (std::size_t i = 0; i < IAE.size(); ++i) sum += (design_->weight.empty() ? 1 : design_->weight[i]) * IAE[i];
        return sum;
    }

    const DecoupledPlants* loops_;
    const Grids* grids_;
    const InteractionDesign* design_;
    Settings settings_;
};

std::vector<IdealPid> with_kind(std::vector<IdealPid> controllers, bool derivative) {
    if (!derivative) return controllers;
    for (IdealPid& one : controllers) {
        one.Td = one.Ti / 8;
        one.filter = {FilterType::measurement_second_order, kTf_over_Td * one.Td};
    }
    return controllers;
}

/// Weaker and weaker until mu holds; empty: never.
std::optional<std::vector<IdealPid>> detuned(const DecoupledPlants& loops, const PlantResponses& responses,
                                             std::vector<IdealPid> controllers, double mu) {
    const auto at_full = controllers;
    for (const double weaker : kWeaker) {
        for (std::size_t i = 0; i < controllers.size(); ++i) {
            controllers[i].Kp = weaker * at_full[i].Kp;
            controllers[i].Ti = at_full[i].Ti / std::sqrt(weaker);
        }
        if (!stable_with(loops, controllers, loops.all_loops())) continue;
        if (mu_peak(responses, controllers, least_of(mu)).value <= mu) return controllers;
    }
    return std::nullopt;
}

/// BLT as it is and detuned, and with one loop quick and the others slow: the optimum has several valleys.
std::vector<std::vector<IdealPid>> starts_of(const std::vector<IdealPid>& first) {
    std::vector<std::vector<IdealPid>> out{first};
    for (std::size_t quick = 0; quick < first.size(); ++quick) {
        auto start = first;
        for (std::size_t i = 0; i < start.size(); ++i) {
            const double factor = i == quick ? kFaster : 1 / kFaster;
            start[i].Kp *= std::sqrt(factor);
            start[i].Ti /= factor;
        }
        out.push_back(std::move(start));
    }
    return out;
}

struct Valley {
    InteractionSearch search;
    LimitedResult found;

    double merit() const { return merit_of(found.log_cost, found.excess); }
    bool is_that_of(const Valley& other) const {
        if (!std::isfinite(merit()) || !std::isfinite(other.merit())) return false;
        const auto mine = parallel(search.controllers(found.x)),
                   its = parallel(other.search.controllers(other.found.x));
        for (std::size_t i = 0; i < mine.size(); ++i)
            for (const auto of : {&ParallelPid::Kp, &ParallelPid::Ki, &ParallelPid::Kd})
                if (mine[i].*of != its[i].*of && !(std::abs(std::log(mine[i].*of / its[i].*of)) < kSameValley))
                    return false;
        return true;
    }
};

/// A few steps from every start; then to the end from those that are not far behind the best and not in the valley of a
/// better one.
std::vector<Valley> searched_valleys(const DecoupledPlants& loops, const Grids& grids, const InteractionDesign& design,
                                     const std::vector<IdealPid>& single, const RunControl& control) {
    const auto starts = starts_of(single);
    std::vector<std::optional<Valley>> first(starts.size());
    parallel_for(control.spread, int(starts.size()), [&](int i) {
        const auto start = detuned(loops, grids.searched, with_kind(starts[std::size_t(i)], design.derivative),
                                   kStartAbove * design.mu);
        if (!start) return;
        const InteractionSearch search(loops, grids, design, *start);
        const LimitedOptions few{.max_iterations = kFirstIterations, .max_rounds = 1, .stop = control.stop};
        first[std::size_t(i)] = Valley{search, search.run(search.start(), few)};
    });
    std::vector<Valley> valleys;
    for (auto& one : first)
        if (one) valleys.push_back(std::move(*one));
    std::ranges::stable_sort(valleys, {}, &Valley::merit);
    std::vector<Valley> kept;
    for (const Valley& one : valleys)
        if (!(one.merit() > valleys.front().merit() + kHopeless) &&
            std::ranges::none_of(kept, [&](const Valley& better) { return one.is_that_of(better); }))
            kept.push_back(one);
    parallel_for(control.spread, int(kept.size()), [&](int i) {
        Valley& valley = kept[std::size_t(i)];
        if (!std::isfinite(valley.merit()) || valley.found.stopped) return;
        valley.found = valley.search.run(valley.found.x, {.curvature = valley.found.curvature, .stop = control.stop});
    });
    return kept;
}

/// The method robust for each loop alone.
Expected<std::vector<IdealPid>> single_settings(const PlantMatrix& plants, double Ms, const RunControl& control) {
    std::vector<IdealPid> out;
    for (std::size_t i = 0; i < plants.size(); ++i) {
        auto settings = robust_settings(*plants[i][i], {.Ms = Ms, .Mt = Ms}, control);
        if (!settings) return Error{settings.error().kind, "plant/" + std::to_string(i), settings.error().message};
        out.push_back(*settings);
    }
    return out;
}

}  // namespace

Expected<InteractionFigures> judge_interaction(const PlantMatrix& plants, const std::vector<IdealPid>& controllers,
                                               const Decoupling& decoupling) {
    if (auto error = without_diagonal(plants)) return *error;
    const DecoupledPlants loops{plants, decoupling};
    const auto n = Index(plants.size());
    const auto diagram = diagram_of(loops, controllers, loops.all_loops());
    if (!diagram) return diagram.error();
    InteractionFigures out;
    for (unsigned closed = 1; closed <= loops.all_loops(); ++closed) {
        if (stable_with(loops, controllers, closed)) continue;
        std::vector<int> unstable;
        for (int i = 0; i < int(n); ++i)
            if (((closed >> i) & 1u) != 0) unstable.push_back(i);
        out.unstable_subsets.push_back(std::move(unstable));
    }
    for (unsigned i = 0; i < plants.size(); ++i)
        out.may_open.push_back(stable_with(loops, controllers, loops.all_loops() & ~(1u << i)));
    out.stable = stable_with(loops, controllers, loops.all_loops());
    if (!out.stable) return out;
    out.IAE_setpoint = out.IAE_load = Table(std::size_t(n), std::vector<double>(std::size_t(n)));
    for (Index i = 0; i < n; ++i) {
        const auto k = std::size_t(i);
        const DiagramLoop closed(diagram->blocks, diagram->y[k]);
        out.Ms_others_closed.push_back(find_peaks(closed, make_peak_grid(closed)).S.value);
        const auto own = Loop::make(*plants[k][k], to_parallel(controllers[k]));
        const auto alone = stable_peaks(own);
        out.Ms_alone.push_back(alone ? alone->S.value : kInfinity);
    }
    for (std::size_t j = 0; j < plants.size(); ++j) {
        std::vector<SeenStep> after_load, after_setpoint;
        for (std::size_t i = 0; i < plants.size(); ++i) {
            after_load.push_back({diagram->y[i], diagram->u[i], 0});
            after_setpoint.push_back({diagram->y[i], diagram->u[i], i == j ? 1.0 : 0.0});
        }
        const auto load = step_figures(diagram->blocks, diagram->load[j], after_load),
                   moved = step_figures(diagram->blocks, diagram->r[j], after_setpoint);
        if (!load) return load.error();
        if (!moved) return moved.error();
        for (std::size_t i = 0; i < plants.size(); ++i) {
            out.IAE_load[j][i] = (*load)[i].IAE.value_or(kInfinity);
            out.IAE_setpoint[j][i] = (*moved)[i].IAE.value_or(kInfinity);
        }
    }
    const Grids grids(loops);
    const Peak near = mu_peak(grids.searched, controllers, least_of(1)),
               peak = mu_peak(grids.judged, controllers, least_of(near.value));
    out.mu = peak.value;
    out.omega_mu = peak.omega;
    out.log_modulus = log_modulus(grids.judged, controllers);
    return out;
}

namespace {

Expected<BltSettings> blt_of(const DecoupledPlants& loops) {
    const PlantMatrix& plants = loops.plants;
    std::vector<UltimatePoint> points;
    for (std::size_t i = 0; i < plants.size(); ++i) {
        const auto point = ultimate_point(*plants[i][i]);
        if (!point)
            return Error{ErrorKind::numerical_failure, "plant/" + std::to_string(i),
                         "Plant " + std::to_string(i + 1) +
                             " of the diagonal has no ultimate gain: without dead time "
                             "and with less than three lags no gain makes it oscillate."};
        points.push_back(*point);
    }
    const auto at = [&](double F) {
        std::vector<IdealPid> out;
        for (const UltimatePoint& point : points)
            out.push_back({.Kp = point.Ku / (kUltimateOverKp * F), .Ti = point.Pu * F / kPeriodOverTi});
        return out;
    };
    // The modulus falls as F grows; below the least stable F it says nothing.
    const PlantResponses responses(loops, grid_of(loops, kSearched));
    const double wanted = kDecibels * double(plants.size());
    const auto enough = [&](double F) {
        return stable_with(loops, at(F), loops.all_loops()) && log_modulus(responses, at(F)) < wanted;
    };
    const double F = log_bisect({kMostF, kLeastF}, enough, kOfF).inside;
    return BltSettings{at(F), F};
}

}  // namespace

Expected<BltSettings> blt(const PlantMatrix& plants) {
    if (auto error = without_diagonal(plants)) return *error;
    return blt_of({plants, {}});
}

WrongGains with_wrong_gains(const PlantMatrix& plants, const std::vector<IdealPid>& controllers,
                            const Decoupling& decoupling, double by) {
    double largest = 1;
    for (std::size_t i = 0; i < plants.size(); ++i)
        for (std::size_t j = 0; j < plants.size(); ++j)
            for (const double factor : {1 - by, 1 + by}) {
                if (!plants[i][j]) continue;
                PlantMatrix wrong = plants;
                wrong[i][j] = changed(*plants[i][j], factor, 1);
                const DecoupledPlants loops{wrong, decoupling};
                if (!stable_with(loops, controllers, loops.all_loops())) return {by, false, {}};
                const PlantResponses responses(loops, grid_of(loops, kSearched));
                largest = std::max(largest, mu_peak(responses, controllers, least_of(1)).value);
            }
    return {by, true, largest};
}

Expected<InteractionResult> design_interaction(const PlantMatrix& plants, const InteractionDesign& design,
                                               const RunControl& control) {
    const auto gains = analyse_gains(plants);
    if (!gains) return gains.error();
    if (auto error = without_diagonal(plants)) return *error;
    if (auto error = impossible_pairing(plants, *gains)) return *error;
    const DecoupledPlants loops{plants, design.decoupling};
    const auto luyben = blt_of(loops);
    InteractionResult out;
    out.blt = luyben ? OrReason<BltSettings>(*luyben) : OrReason<BltSettings>({}, luyben.error().message);
    const auto single =
        luyben ? Expected<std::vector<IdealPid>>(luyben->controllers) : single_settings(plants, design.mu, control);
    if (!single) return single.error();
    const Grids grids(loops);
    double least = kInfinity;
    for (const Valley& valley : searched_valleys(loops, grids, design, *single, control)) {
        out.partial = out.partial || valley.found.stopped;
        if (valley.found.excess <= limits::kMaxRelativeExcessFound && valley.found.log_cost < least) {
            least = valley.found.log_cost;
            out.controllers = valley.search.controllers(valley.found.x);
        }
    }
    if (out.controllers.empty() && out.partial)
        return Error{ErrorKind::cancelled, "", "The search was stopped before it found settings."};
    if (out.controllers.empty())
        return Error{ErrorKind::no_feasible_controller, "limit/mu",
                     "No settings were found that keep mu within its limit with every loop stable; allow a larger mu, "
                     "or another pairing."};
    if (const auto weaker = detuned(loops, grids.searched, *single, design.mu)) out.detuned = *weaker;
    auto figures = judge_interaction(plants, out.controllers, design.decoupling);
    if (!figures) return figures.error();
    out.figures = std::move(*figures);
    return out;
}

Expected<StructureView> interaction_view(const std::string& of, const PlantMatrix& plants,
                                         const std::vector<IdealPid>& controllers, const Decoupling& decoupling,
                                         std::optional<double> limit) {
    const DecoupledPlants loops{plants, decoupling};
    auto all = diagram_of(loops, controllers, loops.all_loops());
    if (!all) return all.error();
    StructureView out{.of = of, .diagram = all->blocks, .inputs = {}, .outputs = {}, .curves = {}};
    const auto blocks = std::make_shared<const BlockDiagram>(std::move(all->blocks));
    for (std::size_t i = 0; i < plants.size(); ++i) {
        const std::string number = std::to_string(i + 1);
        out.inputs.push_back({"setpoint_" + number, all->r[i]});
        out.inputs.push_back({"load_" + number, all->load[i]});
        out.outputs.push_back({"y_" + number, all->y[i]});
        out.outputs.push_back({"u_" + number, all->u[i]});
        out.curves.push_back(sensitivity_at("loop_" + number, blocks, all->y[i], {}));
    }
    // Entered at y: a filter or a derivative of the measurement lies between it and the error.
    out.curves.push_back({"mu", limit, [blocks, y = all->y](double omega) {
                              const auto n = Index(y.size());
                              LoopMatrix S(n, n);
                              for (Index j = 0; j < n; ++j) {
                                  const auto x = blocks->response({0, omega}, y[std::size_t(j)]);
                                  for (Index i = 0; i < n; ++i) S(i, j) = x[y[std::size_t(i)]];
                              }
                              return structured_value(S);
                          }});
    return out;
}

}  // namespace tunewright::structure
