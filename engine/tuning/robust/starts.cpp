#include "engine/tuning/robust/starts.h"

#include <algorithm>
#include <cmath>

#include "engine/loop/stability.h"
#include "engine/tuning/robust/cost.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {

namespace {

constexpr double kScanTolerance = 1e-3;       // of the simulations that only rank the starts
constexpr double kRoughCostTolerance = 1e-4;  // of ln of the integrated error of a start
constexpr int kMaxCompared = 12;
constexpr std::size_t kMaxValleys = 4;
constexpr double kLogTdTolerance = 1e-9;         // of ln Td: values within it are the same value of the scan
constexpr double kWiderLimits = 1.4;             // multiple of M - 1
constexpr double kMaxMainlandLogDistance = 0.7;  // of ln Kp
constexpr ScanBox kIslandBox = {
    .Ti_points = 12, .Td_points = 12, .Ti_low = 0.01, .Ti_high = 1000, .Td_low = 0.02, .Td_high = 60};

void consider(Candidate& best, const DesignProblem& problem, const ScanPoint& point) {
    if (log_cost_bound(problem, point.x) >= best.log_cost) return;
    if (!point.verified && !is_stable(problem, point.x)) return;
    const double cost = log_cost(problem, point.x, kScanTolerance);
    if (cost < best.log_cost) best = {point.x, cost, true};
}

/// The least integrated error Ti/Kp needs only sweeps, and is often close to the optimum (Garpinger and Hägglund 2008;
/// Hast et al. 2013).
ScanPoint min_integrated_error(const Sweep& sweep, DesignProblem problem, const ScanPoint& start) {
    problem.objective = Objective::load_ie;
    SqpOptions options;
    options.cost_tolerance = kRoughCostTolerance;
    options.stable_start = start.verified;
    const SqpResult found = minimise(sweep, problem, start.x, options, {});
    return {found.x, found.x[1] - found.x[0], found.stable};
}

std::optional<Candidate> if_below(const Candidate& best, double below) {
    return best.log_cost < below ? std::optional(best) : std::nullopt;
}

}  // namespace

std::optional<Candidate> best_start(const Sweep& sweep, const DesignProblem& problem,
                                    const std::vector<ScanPoint>& points) {
    const ScanPoint integrated = min_integrated_error(sweep, problem, points.front());
    Candidate best;
    consider(best, problem, integrated);
    int compared = 0;
    for (const auto& point : points) {
        if (log_cost_bound(problem, point.x) >= best.log_cost) break;  // the points are in ascending order of it
        if (++compared > kMaxCompared && std::isfinite(best.log_cost)) break;
        consider(best, problem, point);
    }
    if (std::isfinite(best.log_cost)) return best;
    // If no response settles within the allowed steps (very different time scales), the least integrated error is still
    // a design.
    if (feasible_near(sweep, integrated.x)) return Candidate{integrated.x, integrated.log_ie, false};
    return std::nullopt;
}

std::vector<Candidate> valley_starts(const DesignProblem& problem, const std::vector<ScanPoint>& points,
                                     double short_Td) {
    std::vector<Candidate> starts;
    for (const auto& point : points) {
        const auto same_Td = [&](const Candidate& c) {
            return std::abs(std::max(c.x[2], short_Td) - std::max(point.x[2], short_Td)) < kLogTdTolerance;
        };
        auto at = std::find_if(starts.begin(), starts.end(), same_Td);
        if (at == starts.end()) at = starts.insert(starts.end(), Candidate{.x = point.x});
        consider(*at, problem, point);
    }
    std::erase_if(starts, [](const Candidate& c) { return !std::isfinite(c.log_cost); });
    std::sort(starts.begin(), starts.end(),
              [](const Candidate& a, const Candidate& b) { return a.log_cost < b.log_cost; });
    // Runs with the integrated error need no simulation.
    if (starts.size() > kMaxValleys && problem.objective != Objective::load_ie) starts.resize(kMaxValleys);
    return starts;
}

std::optional<Candidate> lowest_cost(const DesignProblem& problem, const std::vector<ScanPoint>& points, double below) {
    Candidate best{.log_cost = below};
    for (const auto& point : points) consider(best, problem, point);
    return if_below(best, below);
}

namespace {

constexpr double kRelativeInset = 1e-9;   // of a gain: distance from the end of a gap
constexpr double kMinWideGapRatio = 1.3;  // ratio of a gap's ends: narrower gaps lie between the grid's points

std::vector<double> spaced(double low, double high, int n) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) values.push_back(low * std::pow(high / low, n > 1 ? double(i) / (n - 1) : 0.5));
    return values;
}

}  // namespace

namespace {

/// False: there is no design between the gap's ends.
bool is_open(const GainGap& gap) {
    return std::isfinite(gap.upper) && gap.upper > gap.lower * (1 + kRelativeInset) && gap.stable != false;
}

/// True if the loop is verified as stable between a gap's ends; empty: there is no design.
std::optional<bool> usable(const DesignProblem& problem, const GainGap& gap, double Ti, double Td, Stability wanted) {
    if (!is_open(gap)) return std::nullopt;
    if (gap.verified || (wanted == Stability::inferred && gap.stable)) return gap.verified;
    if (!is_stable(problem, {std::log(gap.middle()), std::log(Ti), problem.pid ? std::log(Td) : 0}))
        return std::nullopt;
    return true;
}

/// The gap's upper end, with its largest gain.
ScanPoint end_of(const GainGap& gap, const DesignProblem& problem, double Ti, double Td) {
    const double Kp = gap.upper * (1 - kRelativeInset);
    return {{std::log(Kp), std::log(Ti), problem.pid ? std::log(Td) : 0}, std::log(Ti / Kp), gap.verified};
}

/// With the largest of feasible_gains; empty if there is none, or if its cost is certainly not below `below`.
std::optional<ScanPoint> point_at(const Sweep& sweep, double Ti, double Td, Stability wanted, double below) {
    const DesignProblem& problem = sweep.problem();
    const auto gaps = sweep.gain_gaps(Ti, Td);
    for (std::size_t i = gaps.size(); i-- > 0;) {
        ScanPoint end = end_of(gaps[i], problem, Ti, Td);
        if (std::isfinite(end.x[0]) && log_cost_bound(problem, end.x) >= below) continue;
        if (const auto verified = usable(problem, gaps[i], Ti, Td, wanted)) {
            end.verified = *verified;
            return end;
        }
    }
    return std::nullopt;
}

}  // namespace

std::vector<FeasibleGain> feasible_gains(const Sweep& sweep, double Ti, double Td, Stability wanted) {
    const auto gaps = sweep.gain_gaps(Ti, Td);
    std::vector<FeasibleGain> gains;
    for (std::size_t i = gaps.size(); i-- > 0;) {
        const GainGap& gap = gaps[i];
        const auto verified = usable(sweep.problem(), gap, Ti, Td, wanted);
        if (!verified) continue;
        gains.push_back({gap.upper * (1 - kRelativeInset), *verified});
        if (gap.lower > 0) gains.push_back({gap.lower * (1 + kRelativeInset), *verified});
    }
    return gains;
}

namespace {

/// The points that add(found, Ti, Td) adds at every position of the box, in ascending order of `log_ie`.
template <class Add>
std::vector<ScanPoint> points_over(const Sweep& sweep, const ScanBox& box, const Add& add) {
    const double unit = 1 / sweep.reference();
    std::vector<ScanPoint> found;
    const auto Td_values =
        sweep.problem().pid ? spaced(box.Td_low * unit, box.Td_high * unit, box.Td_points) : std::vector<double>{1.0};
    for (const double Ti : spaced(box.Ti_low * unit, box.Ti_high * unit, box.Ti_points))
        for (const double Td : Td_values) add(found, Ti, Td);
    std::sort(found.begin(), found.end(), [](const ScanPoint& a, const ScanPoint& b) { return a.log_ie < b.log_ie; });
    return found;
}

}  // namespace

std::vector<ScanPoint> scan(const Sweep& sweep, const ScanBox& box, Stability wanted, double below) {
    return points_over(sweep, box, [&](std::vector<ScanPoint>& found, double Ti, double Td) {
        if (const auto point = point_at(sweep, Ti, Td, wanted, below)) found.push_back(*point);
    });
}

std::optional<DesignPoint> first_stable(const Sweep& sweep, const ScanBox& box, Stability wanted) {
    const bool measured = sweep.problem().measured != nullptr;
    const auto worth_counting = [&](const GainGap& gap) {
        return wanted == Stability::verified && (measured || gap.upper > kMinWideGapRatio * gap.lower);
    };
    const auto add_open = [&](std::vector<ScanPoint>& open, double Ti, double Td) {
        for (const GainGap& gap : sweep.gain_gaps(Ti, Td))
            if (is_open(gap) && (gap.stable || worth_counting(gap)))
                open.push_back(end_of(gap, sweep.problem(), Ti, Td));
    };
    for (const ScanPoint& point : points_over(sweep, box, add_open))
        if (point.verified || is_stable(sweep.problem(), point.x)) return point.x;
    return std::nullopt;
}

namespace {

/// True if the true limits allow nearly as high a gain at the same Ti and Td: then other scans have covered this
/// region.
bool on_mainland(const Sweep& sweep, const DesignPoint& x) {
    const auto gains = feasible_gains(sweep, std::exp(x[1]), std::exp(x[2]), Stability::inferred);
    return !gains.empty() && std::log(gains.front().Kp) > x[0] - kMaxMainlandLogDistance;
}

}  // namespace

std::optional<Candidate> lowest_cost_island(const Sweep& sweep, const DesignProblem& problem, double below) {
    DesignProblem wider = problem;
    for (double* limit : {&wider.limits.Ms, &wider.limits.Mt}) *limit = 1 + (*limit - 1) * kWiderLimits;
    Candidate best{.log_cost = below};
    for (const auto& point : scan(Sweep(wider, sweep.reference()), kIslandBox, Stability::inferred, below)) {
        if (log_cost_bound(problem, point.x) >= best.log_cost || on_mainland(sweep, point.x)) continue;
        if (const auto inside = feasible_near(sweep, point.x))
            consider(best, problem, {.x = *inside, .verified = true});
    }
    return if_below(best, below);
}

}  // namespace tunewright::robust
