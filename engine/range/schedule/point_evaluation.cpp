#include "engine/range/schedule/point_evaluation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include "engine/tuning/limits.h"

#include "engine/tuning/robust/sqp.h"

namespace tunewright::range {
namespace {

constexpr double kMinLogRatioOfAll = -5;       // ln of a limit's ratio: every peak counts
constexpr double kMinLogRatioOfHigh = -0.05;   // ln of a limit's ratio: only peaks near the limit count
constexpr double kEvaluationTolerance = 3e-4;  // of the simulations
constexpr double kFineTolerance = 1e-5;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void add_setting(PointEvaluation& evaluation, const PointDesign& place, const robust::DesignPoint& x,
                 double log_own_IAE, double above) {
    const PeakLimits& limits = place.problem().limits;
    for (const auto& peak : place.sweep().peaks(x, above)) {
        evaluation.excess = std::max(evaluation.excess, peak.value);
        if (peak.kind == robust::ConstraintKind::S)
            evaluation.Ms = std::max(evaluation.Ms, limits.Ms * std::exp(peak.value));
        if (peak.kind == robust::ConstraintKind::T)
            evaluation.Mt = std::max(evaluation.Mt, limits.Mt * std::exp(peak.value));
    }
    evaluation.stable = evaluation.stable && robust::is_stable(place.problem(), x);
    double log_IAE = evaluation.stable ? robust::log_cost(place.problem(), x, kEvaluationTolerance) : kInfinity;
    // A coarse run may miss that a slow tail has settled.
    if (evaluation.stable && !std::isfinite(log_IAE)) log_IAE = robust::log_cost(place.problem(), x, kFineTolerance);
    evaluation.log_cost_ratio = std::max(evaluation.log_cost_ratio, log_IAE - log_own_IAE);
}

}  // namespace

robust::DesignPoint point_of(const IdealPid& pid) {
    return {std::log(std::abs(pid.Kp)), std::log(pid.Ti), pid.Td > 0 ? std::log(pid.Td) : -kInfinity};
}

std::vector<IdealPid> in_use(const Schedule& schedule, double at) {
    if (schedule.interpolation != Interpolation::steps) return {settings_at(schedule, at)};
    std::vector<IdealPid> result;
    const double half = 0.5 * schedule.hysteresis;
    for (std::size_t k = 0; k < schedule.rows.size(); ++k) {
        const bool above = k == 0 || at >= schedule.rows[k].at - half;
        const bool below = k + 1 == schedule.rows.size() || at <= schedule.rows[k + 1].at + half;
        if (above && below) result.push_back(controller_of(schedule.rows[k]));
    }
    return result;
}

PointEvaluation evaluate_at(const PointDesign& place, const std::vector<IdealPid>& settings, double log_own_IAE,
                            bool all_peaks) {
    const double above = all_peaks ? kMinLogRatioOfAll : kMinLogRatioOfHigh;
    PointEvaluation evaluation{
        .at = place.at(), .stable = true, .Ms = 1, .Mt = 0, .excess = above, .log_cost_ratio = -kInfinity};
    for (const IdealPid& pid : settings) add_setting(evaluation, place, point_of(pid), log_own_IAE, above);
    if (!evaluation.stable) evaluation.excess = evaluation.log_cost_ratio = kInfinity;
    return evaluation;
}

Expected<PointEvaluation> evaluate_between(const PointDesigns& places, const OwnOptima& own,
                                           const std::vector<IdealPid>& settings, double at, bool all_peaks) {
    auto model = places.model().at(at);
    if (!model) return model.error();
    const PointDesign place(std::move(*model), places.rules());
    return evaluate_at(place, settings, own.log_IAE(at), all_peaks);
}

namespace {

constexpr int kRangeEvaluations = 48;            // points over the range at which a schedule is verified first
constexpr int kPartEvaluations = 9;              // and between two points at which plant or settings have a kink
constexpr double kMaxSmallLogExcess = 5e-4;      // ln of the excess: a smaller one tightens all limits, a larger one
                                                 // adds a point
constexpr double kMinLogRatioNearLimit = -5e-3;  // ln of a limit's ratio: higher maxima are refined
constexpr double kMaxLogCostGap = 0.01;          // of ln of the cost, below the allowed one: the same
constexpr std::size_t kMaxPointsPerRound = 6;    // points added per round

std::vector<double> evaluation_places(const PointDesigns& places, const Schedule& schedule) {
    const double low = places.model().low(), high = places.model().high();
    std::vector<double> at;
    for (int i = 0; i <= kRangeEvaluations; ++i) at.push_back(low + (high - low) * i / kRangeEvaluations);
    const std::vector<double> bends = bends_of(places.model(), schedule);
    at.insert(at.end(), bends.begin(), bends.end());
    for (std::size_t k = 1; k < bends.size(); ++k) {
        const double from = bends[k - 1], width = bends[k] - from;
        for (int i = 0; i < kPartEvaluations; ++i) at.push_back(from + width * (i + 0.5) / kPartEvaluations);
    }
    std::ranges::sort(at);
    at.erase(std::ranges::unique(at).begin(), at.end());
    return at;
}

/// Evaluations over the range, ascending, with more of them near a limit or the allowed cost.
class ScheduleEvaluations {
public:
    ScheduleEvaluations(const PointDesigns& places, const OwnOptima& own, const Schedule& schedule)
        : places_(places), own_(own), schedule_(schedule) {}

    std::optional<Error> take(double at) {
        const auto evaluation = evaluate_between(places_, own_, in_use(schedule_, at), at, false);
        if (!evaluation) return evaluation.error();
        const auto after = std::ranges::upper_bound(evaluations_, at, {}, &PointEvaluation::at);
        evaluations_.insert(after, *evaluation);
        return std::nullopt;
    }

    /// Adds one evaluation at the maximum of the parabola through each local maximum above the threshold and its
    /// neighbours.
    std::optional<Error> refine(double PointEvaluation::*value, double threshold) {
        std::vector<double> wanted;
        for (std::size_t i = 1; i + 1 < evaluations_.size(); ++i) {
            const PointEvaluation &a = evaluations_[i - 1], &b = evaluations_[i], &c = evaluations_[i + 1];
            if (!is_top(i, value) || !(b.*value > threshold) || !std::isfinite(a.*value + b.*value + c.*value))
                continue;
            const double left = (b.*value - a.*value) / (b.at - a.at), right = (c.*value - b.*value) / (c.at - b.at);
            const double bend = (right - left) / (c.at - a.at);
            if (!(bend < 0)) continue;
            const double top = 0.5 * (a.at + b.at) - 0.5 * left / bend;
            if (top > a.at && top < c.at && top != b.at) wanted.push_back(top);
        }
        for (const double at : wanted)
            if (auto error = take(at)) return error;
        return std::nullopt;
    }

    double largest(double PointEvaluation::*value) const {
        return (*std::ranges::max_element(evaluations_, {}, value)).*value;
    }

    /// Local maxima above the threshold, the largest first.
    std::vector<double> tops(double PointEvaluation::*value, double threshold) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < evaluations_.size(); ++i)
            if (evaluations_[i].*value > threshold && (is_top(i, value) || !std::isfinite(evaluations_[i].*value)))
                found.push_back(i);
        std::ranges::stable_sort(found, std::greater{}, [&](std::size_t i) { return evaluations_[i].*value; });
        found.resize(std::min(found.size(), kMaxPointsPerRound));
        std::vector<double> at;
        for (const std::size_t i : found) at.push_back(evaluations_[i].at);
        return at;
    }

private:
    bool is_top(std::size_t i, double PointEvaluation::*value) const {
        const double here = evaluations_[i].*value;
        return (i == 0 || evaluations_[i - 1].*value <= here) &&
               (i + 1 == evaluations_.size() || evaluations_[i + 1].*value < here);
    }

    const PointDesigns& places_;
    const OwnOptima& own_;
    const Schedule& schedule_;
    std::vector<PointEvaluation> evaluations_;
};

}  // namespace

std::vector<double> bends_of(const RangeModel& model, const Schedule& schedule) {
    std::vector<double> bends = model.points();
    for (const ScheduleRow& row : schedule.rows)
        if (row.at >= model.low() && row.at <= model.high()) bends.push_back(row.at);
    std::ranges::sort(bends);
    bends.erase(std::ranges::unique(bends).begin(), bends.end());
    return bends;
}

Expected<Verified> verify(const PointDesigns& places, const OwnOptima& own, const Schedule& schedule, double allowed) {
    ScheduleEvaluations evaluations(places, own, schedule);
    for (const double at : evaluation_places(places, schedule))
        if (auto error = evaluations.take(at)) return *error;
    for (int round = 0; round < 2; ++round) {
        if (auto error = evaluations.refine(&PointEvaluation::excess, kMinLogRatioNearLimit)) return *error;
        if (auto error = evaluations.refine(&PointEvaluation::log_cost_ratio, allowed - kMaxLogCostGap)) return *error;
    }
    Verified result{.excess = evaluations.largest(&PointEvaluation::excess),
                    .log_cost_ratio = evaluations.largest(&PointEvaluation::log_cost_ratio),
                    .worst = {}};
    const bool little = result.excess <= kMaxSmallLogExcess && result.log_cost_ratio <= allowed;
    if (!little) result.worst = evaluations.tops(&PointEvaluation::excess, limits::kMaxRelativeExcessVerified);
    const auto over_allowance = evaluations.tops(&PointEvaluation::log_cost_ratio, allowed);
    result.worst.insert(result.worst.end(), over_allowance.begin(), over_allowance.end());
    return result;
}

}  // namespace tunewright::range
