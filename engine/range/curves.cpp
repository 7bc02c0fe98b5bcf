#include "engine/range/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/range/one_setting.h"

namespace tunewright::range {
namespace {

constexpr double kUnstable = std::numeric_limits<double>::infinity();
constexpr int kRefinements = 2;  // evaluations at the maximum of a parabola, for the worst point of a quantity

double value_of(const PointEvaluation& evaluation, Quantity quantity) {
    if (!evaluation.stable) return kUnstable;
    if (quantity == Quantity::Ms) return evaluation.Ms;
    if (quantity == Quantity::Mt) return evaluation.Mt;
    return std::exp(evaluation.log_cost_ratio);
}

PointFigures figures(const PointEvaluation& evaluation) {
    const std::string why = evaluation.stable ? "The response does not settle." : "The loop is not stable here.";
    PointFigures result{
        .at = evaluation.at, .Ms = no_figure(why), .Mt = no_figure(why), .relative_IAE = no_figure(why)};
    if (!evaluation.stable) return result;
    result.Ms = evaluation.Ms;
    result.Mt = evaluation.Mt;
    result.relative_IAE = finite_or(std::exp(evaluation.log_cost_ratio), why);
    return result;
}

/// The evaluations along a curve, in ascending order, and the search for the worst point between them.
class CurveEvaluations {
public:
    CurveEvaluations(PointDesigns& places, OwnOptima& own, const SettingsInUse& settings)
        : places_(places), own_(own), settings_(settings) {}

    std::optional<Error> take(double at) {
        const auto evaluation = evaluate_between(places_, own_, settings_(at), at, true);
        if (!evaluation) return evaluation.error();
        evaluations_.insert(std::ranges::upper_bound(evaluations_, at, {}, &PointEvaluation::at), *evaluation);
        return std::nullopt;
    }

    std::optional<Error> refine(Quantity quantity) {
        for (int k = 0; k < kRefinements; ++k) {
            const std::size_t i = largest(quantity);
            if (i == 0 || i + 1 == evaluations_.size()) return std::nullopt;
            const auto value = [&](std::size_t j) { return value_of(evaluations_[j], quantity); };
            const double x = evaluations_[i].at, left = (value(i) - value(i - 1)) / (x - evaluations_[i - 1].at),
                         right = (value(i + 1) - value(i)) / (evaluations_[i + 1].at - x),
                         bend = (right - left) / (evaluations_[i + 1].at - evaluations_[i - 1].at);
            if (!std::isfinite(bend) || !(bend < 0)) return std::nullopt;
            const double top = 0.5 * (x + evaluations_[i - 1].at) - 0.5 * left / bend;
            if (!(top > evaluations_[i - 1].at && top < evaluations_[i + 1].at) || top == x) return std::nullopt;
            if (auto error = take(top)) return error;
        }
        return std::nullopt;
    }

    std::size_t largest(Quantity quantity) const {
        std::size_t worst = 0;
        for (std::size_t i = 1; i < evaluations_.size(); ++i)
            if (value_of(evaluations_[i], quantity) > value_of(evaluations_[worst], quantity)) worst = i;
        return worst;
    }

    const std::vector<PointEvaluation>& all() const { return evaluations_; }

private:
    PointDesigns& places_;
    OwnOptima& own_;
    const SettingsInUse& settings_;
    std::vector<PointEvaluation> evaluations_;
};

/// Evaluates the worst point again, against its own optimum and on a grid that the searches do not use.
Expected<WorstPoint> checked(PointDesigns& places, const SettingsInUse& settings, double at, Quantity quantity,
                             double allowance) {
    const auto place = places.at(at);
    if (!place) return place.error();
    const PeakLimits& limits = places.rules().limits;
    WorstPoint worst{.quantity = quantity, .at = at, .value = {}, .limit = 1 + allowance};
    if (quantity != Quantity::relative_IAE) worst.limit = quantity == Quantity::Ms ? limits.Ms : limits.Mt;
    for (const IdealPid& pid : settings(at)) {
        const PointCost cost = cost_at(**place, pid);
        const Figure& value = quantity == Quantity::Ms   ? cost.Ms
                              : quantity == Quantity::Mt ? cost.Mt
                                                         : cost.relative_IAE;
        if (!value) {
            worst.value = value;
            return worst;
        }
        if (!worst.value || *worst.value < *value) worst.value = value;
    }
    return worst;
}

}  // namespace

Expected<RangeCurve> curve_over(PointDesigns& places, OwnOptima& own, const SettingsInUse& settings, int count,
                                const std::vector<double>& extra, double allowance) {
    const double low = places.model().low(), high = places.model().high();
    std::vector<double> wanted = extra;
    for (int i = 0; i < count; ++i) wanted.push_back(i + 1 == count ? high : low + (high - low) * i / (count - 1));
    std::ranges::sort(wanted);
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    CurveEvaluations evaluations(places, own, settings);
    for (const double at : wanted)
        if (auto error = evaluations.take(at)) return *error;
    RangeCurve curve;
    for (const PointEvaluation& evaluation : evaluations.all()) curve.places.push_back(figures(evaluation));
    for (const Quantity quantity : {Quantity::Ms, Quantity::Mt, Quantity::relative_IAE}) {
        if (auto error = evaluations.refine(quantity)) return *error;
        const auto worst =
            checked(places, settings, evaluations.all()[evaluations.largest(quantity)].at, quantity, allowance);
        if (!worst) return worst.error();
        curve.worst.push_back(*worst);
    }
    own.renew(places);
    return curve;
}

std::optional<Error> add_places(RangeCurve& curve, const PointDesigns& places, const OwnOptima& own,
                                const SettingsInUse& settings, const std::vector<double>& at) {
    for (const double place : at) {
        const auto after = std::ranges::lower_bound(curve.places, place, {}, &PointFigures::at);
        if (after != curve.places.end() && after->at == place) continue;
        const auto evaluation = evaluate_between(places, own, settings(place), place, true);
        if (!evaluation) return evaluation.error();
        curve.places.insert(after, figures(*evaluation));
    }
    return std::nullopt;
}

double largest_relative_IAE(const RangeCurve& curve) {
    double largest = 0;
    for (const PointFigures& place : curve.places) largest = std::max(largest, place.relative_IAE.value_or(kUnstable));
    for (const WorstPoint& worst : curve.worst)
        if (worst.quantity == Quantity::relative_IAE) largest = std::max(largest, worst.value.value_or(kUnstable));
    return largest;
}

double largest_excess(const RangeCurve& curve) {
    double largest = -1;
    for (const WorstPoint& worst : curve.worst)
        if (worst.quantity != Quantity::relative_IAE)
            largest = std::max(largest, worst.value.value_or(kUnstable) / worst.limit - 1);
    return largest;
}

}  // namespace tunewright::range
