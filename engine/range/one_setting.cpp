#include "engine/range/one_setting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/evaluation/best_so_far.h"
#include "engine/number_text.h"
#include "engine/range/one_setting_problem.h"
#include "engine/range/schedule/point_evaluation.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/feasibility.h"
#include "engine/tuning/robust/sqp.h"
#include "engine/tuning/robust/verified_search.h"

namespace tunewright::range {
namespace {

using robust::DesignPoint;

constexpr double kInfiniteLogCost = std::numeric_limits<double>::infinity();
constexpr double kCompareTolerance = 1e-3;   // of simulations that only rank the starts
constexpr double kReportedTolerance = 1e-5;  // of simulations whose results are reported
constexpr double kMaxSameDesignLog = 0.03;   // in each logarithm: two ends within it are the same design
constexpr int kRounds = 4;                   // rounds of searches with tighter limits
constexpr int kRegionRounds = 10;            // rounds in which the worst plants inside regions are added

/// All plants of all points as one problem; the first point's is nominal.
struct Together {
    std::vector<LinearPlant> others;
    robust::DesignProblem problem;

    Together(const std::vector<PointDesign*>& points, bool PI) : problem(points.front()->problem()) {
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto& model = points[k]->model();
            if (k > 0) others.push_back(*model.nominal);
            others.insert(others.end(), model.members.begin(), model.members.end());
        }
        problem.others = others;
        problem.objective = robust::Objective::load_ie;
        if (PI) problem.pid = false;
    }
};

double middle_reference(const std::vector<PointDesign*>& points) {
    double sum = 0;
    for (const PointDesign* place : points) sum += std::log(place->sweep().reference());
    return std::exp(sum / double(points.size()));
}

double log_cost_ratio_of(const std::vector<PointDesign*>& points, const DesignPoint& x, Aim aim, double tolerance) {
    double worst = -kInfiniteLogCost, sum = 0;
    for (const PointDesign* place : points) {
        if (!robust::is_stable(place->problem(), x)) return kInfiniteLogCost;
        const double cost = place->log_cost_ratio(x, tolerance);
        worst = std::max(worst, cost);
        sum += std::exp(cost);
    }
    return aim == Aim::worst ? worst : std::log(sum / double(points.size()));
}

/// The starts of the searches: the design with the least integrated error, which needs no simulation, and the cheapest
/// own optimum that can be moved within the limits of all points. Cheapest first.
Expected<std::vector<DesignPoint>> starts(const std::vector<PointDesign*>& points, const RangeOptions& options, bool PI,
                                          const RunControl& control) {
    Together together(points, PI);
    robust::DesignProblem problem = together.problem;
    const RunControl quiet{.stop = control.stop, .progress = {}, .now_ms = {}};
    const auto integrated =
        robust::verified_search(robust::SearchKind::fast, problem, std::nullopt, nullptr, quiet, nullptr);
    if (!integrated) return placed_in_options(integrated.error());
    std::vector<std::pair<double, DesignPoint>> found;
    const auto consider = [&](DesignPoint x) {
        const double min = 1.01 * robust::kMinTd / middle_reference(points);
        if (problem.pid) x[2] = std::max(x[2], std::log(min));
        if (PI) x[2] = -kInfiniteLogCost;
        found.emplace_back(log_cost_ratio_of(points, x, options.aim, kCompareTolerance), x);
    };
    consider(integrated->x);
    const robust::Sweep sweep(together.problem, middle_reference(points));
    for (const PointDesign* place : points)
        if (const auto inside = robust::feasible_near(sweep, place->optimum())) consider(*inside);
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<DesignPoint> result;
    for (const auto& [cost, x] : found) result.push_back(x);
    return result;
}

double largest_excess(const std::vector<PointDesign*>& points, const DesignPoint& x) {
    double worst = -1;
    for (const PointDesign* place : points) worst = std::max(worst, place->excess(x));
    return worst;
}

bool same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - b).cwiseAbs().maxCoeff() < kMaxSameDesignLog;
}

class Progressing {
public:
    Progressing(const DesignRules& rules, const RunControl& control, const PeakLimits& limits)
        : rules_(rules), control_(control), limits_(limits) {}

    void operator()(const JointResult& result, const DesignPoint& x) {
        if (!control_.progress || !result.holds()) return;
        ++steps_;
        Progress progress{.fraction = 0.3 * (1 - std::pow(0.85, steps_)), .stage = "tune", .message = {}, .best = {}};
        progress.message =
            "one setting: at worst " + text(std::exp(result.log_cost_ratio), 3) + " times the own optimum.";
        progress.best = std::make_shared<const BestSoFar>(
            BestSoFar{setting_at(rules_, x, 1), std::exp(result.log_cost_ratio), limits_.Ms, limits_.Mt});
        control_.progress(progress);
    }

private:
    const DesignRules& rules_;
    const RunControl& control_;
    const PeakLimits& limits_;
    int steps_ = 0;
};

/// The best end of the searches from the starts; the limits hold on the searches' grids.
JointResult best_end(const JointProblem& joint, const std::vector<DesignPoint>& starts, const JointOptions& search,
                     Progressing& progress) {
    std::optional<JointResult> best;
    int runs = 0;
    std::vector<Eigen::VectorXd> begun;
    for (const DesignPoint& start : starts) {
        const Eigen::VectorXd v = unknowns_of(joint, start);
        if (std::ranges::any_of(begun, [&](const auto& other) { return same(other, v); })) continue;
        begun.push_back(v);
        auto end = search_jointly(joint, v, search, [&](const JointResult& so_far) {
            progress(so_far, joint.settings(so_far.v, 0, nullptr));
        });
        const bool better = !best || (end.holds() && (!best->holds() || end.log_cost_ratio < best->log_cost_ratio));
        const bool stopped = end.stopped;
        if (better) best = std::move(end);
        if (stopped || ++runs == 2) break;
    }
    return *best;
}

}  // namespace

IdealPid setting_at(const DesignRules& rules, const DesignPoint& x, double b) {
    robust::DesignProblem problem;
    problem.pid = rules.pid;
    problem.filter = rules.filter;
    problem.sign = rules.sign;
    IdealPid pid = robust::controller_at(problem, x);
    pid.b = b;
    return pid;
}

namespace {

/// Peaks on every plant of the point, including those set aside; empty if a loop is unstable.
std::optional<Peaks> worst_peaks(const PointDesign& place, const IdealPid& controller) {
    const ParallelPid gains = to_parallel(controller);
    std::optional<Peaks> worst;
    const auto take = [&](const auto& loop) {
        const auto peaks = stable_peaks(loop);
        if (!peaks) return false;
        if (!worst) worst = peaks;
        if (peaks->S.value > worst->S.value) worst->S = peaks->S;
        if (peaks->T.value > worst->T.value) worst->T = peaks->T;
        return true;
    };
    if (!robust::holds_on_every_loop(place.problem(), gains, take)) return std::nullopt;
    for (const LinearPlant& plant : place.set_aside())
        if (!take(Loop::make(plant, gains))) return std::nullopt;
    return worst;
}

void add_peaks(const PointDesign& place, const IdealPid& controller, PointCost& cost) {
    const std::string unstable = "The loop is not stable here.";
    const auto peaks = worst_peaks(place, controller);
    cost.Ms = peaks ? finite_or(peaks->S.value, unstable) : no_figure(unstable);
    cost.Mt = peaks ? finite_or(peaks->T.value, unstable) : no_figure(unstable);
}

}  // namespace

PointCost cost_at(const PointDesign& place, const IdealPid& controller) {
    const DesignRules rules{
        .pid = place.problem().pid, .filter = place.problem().filter, .limits = {}, .sign = place.problem().sign};
    PointCost cost{.at = place.at(),
                   .own = setting_at(rules, place.own_design(), controller.b),
                   .own_IAE = std::exp(place.optimum_log_cost()),
                   .IAE = {},
                   .relative_IAE = {},
                   .Ms = {},
                   .Mt = {}};
    add_peaks(place, controller, cost);
    const double log_cost_ratio =
        cost.Ms ? place.log_cost_ratio(point_of(controller), kReportedTolerance) : kInfiniteLogCost;
    const std::string why = cost.Ms ? "The response does not settle." : "The loop is not stable here.";
    cost.relative_IAE = finite_or(std::exp(log_cost_ratio), why);
    cost.IAE = finite_or(std::exp(log_cost_ratio) * cost.own_IAE, why);
    return cost;
}

namespace {

struct VerifiedEnd {
    DesignPoint x{};
    bool stopped = false;
};

/// The best end that also keeps the limits on the independent grid; if it does not, the search is repeated with tighter
/// limits.
Expected<VerifiedEnd> verified_end(const std::vector<PointDesign*>& points, const JointProblem& joint,
                                   const std::vector<DesignPoint>& from, const RunControl& control,
                                   Progressing& progress) {
    JointOptions search;
    search.stop = control.stop;
    JointResult end = best_end(joint, from, search, progress);
    for (int round = 0; round < kRounds; ++round) {
        const DesignPoint x = joint.settings(end.v, 0, nullptr);
        const double excess = largest_excess(points, x);
        if (excess <= limits::kMaxRelativeExcessFound) return VerifiedEnd{x, end.stopped};
        if (!std::isfinite(excess)) break;
        search.margin += 1.5 * excess + 1e-6;
        end = search_jointly(joint, end.v, search, {});
    }
    return Error{ErrorKind::numerical_failure, "",
                 "The one setting found does not hold its limits on the independent frequency grid, so it is not "
                 "returned. Use a filter with a longer Tf, or raise the limits slightly."};
}

OneSetting described(const std::vector<PointDesign*>& points, const DesignRules& rules, const DesignPoint& x,
                     double b) {
    OneSetting one{.controller = setting_at(rules, x, b), .points = {}};
    for (const PointDesign* place : points) {
        one.points.push_back(cost_at(*place, one.controller));
        const double relative = one.points.back().relative_IAE.value_or(kInfiniteLogCost);
        one.mean_relative_IAE += relative / double(points.size());
        if (relative <= one.worst_relative_IAE) continue;
        one.worst_relative_IAE = relative;
        one.worst_at = place->at();
    }
    return one;
}

/// `PI`: with Td = 0, as in one_setting_problem.
Expected<OneSetting> found_setting(const std::vector<PointDesign*>& points, PointDesigns& places,
                                   const RangeOptions& options, bool PI) {
    Progressing progress(places.rules(), places.control(), options.limits);
    auto from = starts(points, options, PI, places.control());
    if (!from) return from.error();
    for (int round = 0;; ++round) {
        const JointProblem joint = one_setting_problem(points, options, PI);
        const auto end = verified_end(points, joint, *from, places.control(), progress);
        if (!end) return end.error();
        bool added = false;
        for (PointDesign* place : points) added = place->add_worst_inside(end->x, places.control().stop) || added;
        if (!added || end->stopped || round == kRegionRounds) {
            OneSetting one = described(points, places.rules(), end->x, options.b);
            one.partial = end->stopped;
            return one;
        }
        *from = {end->x};
    }
}

}  // namespace

Expected<OneSetting> design_one_setting(PointDesigns& places, const std::vector<double>& at,
                                        const RangeOptions& options) {
    std::vector<PointDesign*> points;
    for (const double place : at) {
        const auto found = places.at_point(place);
        if (!found) return found.error();
        points.push_back(*found);
    }
    auto one = found_setting(points, places, options, false);
    const bool cut_short = one ? one->partial : one.error().kind == ErrorKind::cancelled;
    if (cut_short || std::ranges::none_of(points, &PointDesign::optimum_is_PI)) return one;
    const auto PI = found_setting(points, places, options, true);
    const auto aim = [&](const OneSetting& setting) {
        return options.aim == Aim::worst ? setting.worst_relative_IAE : setting.mean_relative_IAE;
    };
    return PI && (!one || aim(*PI) < aim(*one)) ? PI : one;
}

}  // namespace tunewright::range
