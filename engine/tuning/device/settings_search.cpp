#include "engine/tuning/device/settings_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/number_text.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/plant/linear/resonance.h"
#include "engine/tuning/device/largest_gain.h"

namespace tunewright::device {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoCost = 1e6;                 // ln of the cost if no gain keeps even wider limits
constexpr double kCostOutsideLimits = 1e3;      // the same if a gain keeps wider limits; it grows with the widening
constexpr double kMaxLimitWidening = 30;        // multiple of M - 1 of the limits
constexpr double kLogWideningTolerance = 0.02;  // accuracy of ln of the widening
constexpr double kFirstStep = 0.25;             // of ln Ti and ln Td
constexpr double kLaterStep = 0.08;             // of the later searches, which start from the best result
constexpr double kMinCostGain = 1e-5;           // relative: the search ends if it gains less
constexpr int kMaxRestarts = 4;
constexpr int kMaxEvaluations = 150;     // of one simplex
constexpr double kTolerance = 1e-6;      // of ln IAE
constexpr int kMaxEvaluationsNear = 50;  // these two for a start that is near the optimum
constexpr double kNearTolerance = 1e-4;
constexpr int kMaxCorrections = 6;
// Relative to M - 1. If limits bound the gain from both sides, the final grid may show no gain that holds them; the
// search is then repeated with the next margin.
constexpr double kMargins[] = {1e-5, 1e-4, 1e-3};
constexpr double kLowerGains[] = {0.95, 0.85, 0.7};  // tried because a loop at its limits may oscillate, so that a
                                                     // lower gain costs less

// A grid over both times for finding local minima other than the start's. A resonance causes minima that a simplex from
// an ordinary design does not find: there Ti is a tenth of Td.
constexpr double kNetStep = 2;  // from one value to the next
constexpr int kNetBelow = 4, kNetAbove = 3;
constexpr double kTdOverTi = 0.1;        // for a start without derivative, because a search needs the logarithm of Td
constexpr double kMinValleyGain = 1e-3;  // relative improvement that makes another local minimum worth a full search
constexpr std::size_t kMaxValleys = 3;   // local minima that get their own simplex

}  // namespace

PeakLimits within(const PeakLimits& limits, double margin) {
    PeakLimits inner{1 + (limits.Ms - 1) * (1 - margin), 1 + (limits.Mt - 1) * (1 - margin), limits.Mks};
    if (inner.Mks) *inner.Mks *= 1 - margin;
    return inner;
}

namespace {

class Search {
public:
    Search(const std::vector<const LinearPlant*>& plants, const Shape& shape, const PeakLimits& limits,
           const Law& first)
        : plants_(plants), shape_(shape), limits_(limits), inner_(within(limits, kMargins[0])) {
        for (const LinearPlant* plant : plants) limiters_.emplace_back(*plant, first);
    }

    void keep_margin(double margin) { inner_ = within(limits_, margin); }

    /// The cost is infinite if no gain keeps the limits, or if its lower bound 1/Ki exceeds `enough`.
    Settings at(double Ti, double Td, double enough = kInfinity);
    /// The factor of M - 1 by which the limits must be widened for some gain to keep them; infinite if no widening
    /// helps. It guides a search from times without a feasible gain to times with one.
    double widening(double Ti, double Td);
    /// With a gain that is confirmed on the whole loop, on its own grid.
    Settings confirmed(double Ti, double Td);

private:
    Law law(double gain, double Ti, double Td) const { return shape_.law(gain, Ti, Td); }
    Settings with_limits(double Ti, double Td, const PeakLimits& limits, double enough = kInfinity);
    double cost(double gain, double Ti, double Td) const { return load_iae_of(*plants_.front(), law(gain, Ti, Td)); }

    const std::vector<const LinearPlant*>& plants_;
    const Shape& shape_;
    const PeakLimits limits_;
    PeakLimits inner_;
    std::vector<GainLimiter> limiters_;
};

Settings Search::with_limits(double Ti, double Td, const PeakLimits& limits, double enough) {
    Settings best{0, Ti, Td, kInfinity};
    const auto k = largest_gain(
        limiters_, [&](double gain) { return law(gain, Ti, Td); }, limits, shape_.gain.high);
    if (!k || *k < shape_.gain.low) return best;
    const double max = *k;
    if (!(1 / std::abs(law(max, Ti, Td).gains.Ki) <= enough)) return best;
    best = {shape_.sign * max, Ti, Td, cost(max, Ti, Td)};
    for (const double share : kLowerGains) {
        const double gain = std::max(share * max, shape_.gain.low);
        // |integral of e| = 1/Ki is a lower bound of the IAE: an error that keeps its sign needs no simulation here.
        if (1 / std::abs(law(gain, Ti, Td).gains.Ki) >= best.load_IAE) break;
        const double lower = cost(gain, Ti, Td);
        if (!(lower < best.load_IAE)) break;
        best = {shape_.sign * gain, Ti, Td, lower};
    }
    return best;
}

Settings Search::at(double Ti, double Td, double enough) {
    return with_limits(shape_.Ti.within(Ti), shape_.Td.within(Td), inner_, enough);
}

double Search::widening(double Ti, double Td) {
    const auto serves = [&](double factor) {
        const PeakLimits wider{1 + factor * (inner_.Ms - 1), 1 + factor * (inner_.Mt - 1), {}};
        const auto k = largest_gain(
            limiters_, [&](double gain) { return law(gain, Ti, Td); }, wider, shape_.gain.high);
        return k && *k >= shape_.gain.low;
    };
    if (!serves(kMaxLimitWidening)) return kInfinity;
    const auto close = [](double serving, double failing) { return serving - failing <= kLogWideningTolerance; };
    return std::exp(bisect(
                        {std::log(kMaxLimitWidening), 0}, [&](double x) { return serves(std::exp(x)); }, close)
                        .inside);
}

Settings Search::confirmed(double Ti, double Td) {
    PeakLimits limits = inner_;
    Settings found;
    for (int i = 0; i < kMaxCorrections; ++i) {
        found = with_limits(shape_.Ti.within(Ti), shape_.Td.within(Td), limits);
        if (!std::isfinite(found.load_IAE)) return found;
        double excess = -kInfinity;
        const Law built = law(std::abs(found.gain), found.Ti, found.Td);
        for (const LinearPlant* plant : plants_) excess = std::max(excess, excess_on(*plant, built, limits_));
        if (excess == kInfinity) return {0, Ti, Td, kInfinity};
        if (excess <= limits::kMaxRelativeExcessSearched) return found;
        limits = within(limits, 2 * excess);
    }
    found.load_IAE = kInfinity;
    return found;
}

Error none(const PeakLimits& limits) {
    return {ErrorKind::no_feasible_controller, "",
            "No settings of this controller keep Ms <= " + text(limits.Ms) + " and Mt <= " + text(limits.Mt) +
                " on the implemented loop. Raise the limit, sample faster, or choose a controller with more actions."};
}

/// The search in the logarithms of the times that the shape has.
class TimesSearch {
public:
    TimesSearch(Search& local, const Shape& shape, const Settings& start) : local_(local), shape_(shape), held_(start) {
        if (shape.has_integral) x_.push_back(std::log(start.Ti));
        if (shape.has_derivative) x_.push_back(std::log(start.Td));
    }

    /// Searches from the start, and again from the best result while that improves; with a larger margin if the final
    /// grid leaves no gain.
    Settings best(Reach reach, const std::stop_token& stop);

private:
    double cost(const std::vector<double>& x) const;
    /// Leaves the best times in x_ and returns their cost.
    double descend(Reach reach, const std::stop_token& stop);
    std::pair<double, double> times(const std::vector<double>& x) const {
        const double first = x.empty() ? 0 : std::exp(x.front()), last = x.empty() ? 0 : std::exp(x.back());
        return {shape_.has_integral ? first : held_.Ti, shape_.has_derivative ? last : held_.Td};
    }

    Search& local_;
    const Shape& shape_;
    const Settings held_;
    std::vector<double> x_;
};

double TimesSearch::cost(const std::vector<double>& x) const {
    const auto [Ti, Td] = times(x);
    const double IAE = local_.at(Ti, Td).load_IAE;
    if (std::isfinite(IAE) && IAE > 0) return std::log(IAE);
    const double factor = local_.widening(shape_.Ti.within(Ti), shape_.Td.within(Td));
    return std::isfinite(factor) ? kCostOutsideLimits + std::log(factor) : kNoCost;
}

double TimesSearch::descend(Reach reach, const std::stop_token& stop) {
    const bool wide = reach == Reach::wide;
    const auto watched = [&](const std::vector<double>& x, bool& end) {
        end = stop.stop_requested();
        return cost(x);
    };
    double reached = cost(x_), step = wide ? kFirstStep : kLaterStep;
    for (int i = 0; i < (wide ? kMaxRestarts : 1) && !x_.empty(); ++i, step = kLaterStep) {
        // A restart shows whether the first simplex has collapsed: a rough one is enough for that.
        const bool fine = wide && i == 0;
        const LocalOptions options{std::vector<double>(x_.size(), step), fine ? kTolerance : kNearTolerance,
                                   wide ? kMaxEvaluations : kMaxEvaluationsNear};
        const auto found = find_local_minimum(LocalSearch::nelder_mead, watched, x_, options);
        const double gained = reached - found.value;
        if (gained > 0) {
            reached = found.value;
            x_ = found.x;
        }
        if (i > 0 && gained < kMinCostGain) break;
    }
    return reached;
}

Settings TimesSearch::best(Reach reach, const std::stop_token& stop) {
    Settings found{0, 0, 0, kInfinity};
    for (const double margin : kMargins) {
        local_.keep_margin(margin);
        const double reached = descend(reach, stop);
        const auto [Ti, Td] = times(x_);
        found = local_.confirmed(Ti, Td);
        if (std::isfinite(found.load_IAE) || reached >= kCostOutsideLimits) break;
    }
    return found;
}

/// The local minima on a grid around the start, the best first; without that at the start, which is searched anyway.
std::vector<Settings> valleys(Search& local, const Shape& shape, const Settings& start, const std::stop_token& stop) {
    const int rows = shape.has_integral ? kNetBelow + 1 + kNetAbove : 1,
              columns = shape.has_derivative ? kNetBelow + 1 + kNetAbove : 1;
    const auto time = [](double from, bool varies, int i) {
        return varies ? from * std::pow(kNetStep, i - kNetBelow) : from;
    };
    std::vector<Settings> net;
    double min = local.at(start.Ti, start.Td).load_IAE;
    for (int i = 0; i < rows && !stop.stop_requested(); ++i)
        for (int j = 0; j < columns; ++j) {
            const double Ti = time(start.Ti, shape.has_integral, i), Td = time(start.Td, shape.has_derivative, j);
            net.push_back(local.at(Ti, Td, min));
            min = std::min(min, net.back().load_IAE);
        }
    if (stop.stop_requested()) return {};
    const auto cost = [&](int i, int j) {
        const bool within = i >= 0 && i < rows && j >= 0 && j < columns;
        return within ? net[static_cast<std::size_t>(i * columns + j)].load_IAE : kInfinity;
    };
    std::vector<Settings> found;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const bool at_start = (i == kNetBelow || rows == 1) && (j == kNetBelow || columns == 1);
            bool lowest = !at_start && std::isfinite(cost(i, j));
            for (int a = -1; a <= 1; ++a)
                for (int b = -1; b <= 1; ++b) lowest = lowest && cost(i, j) <= cost(i + a, j + b);
            if (lowest) found.push_back(net[static_cast<std::size_t>(i * columns + j)]);
        }
    std::sort(found.begin(), found.end(), [](const Settings& a, const Settings& b) { return a.load_IAE < b.load_IAE; });
    if (found.size() > kMaxValleys) found.resize(kMaxValleys);
    return found;
}

}  // namespace

Expected<Settings> search(const std::vector<const LinearPlant*>& plants, const Shape& shape, const PeakLimits& limits,
                          const std::vector<Settings>& starts, const RunControl& control, Reach reach) {
    std::optional<Settings> best;
    for (Settings start : starts) {
        start.Ti = shape.Ti.within(start.Ti);
        start.Td = shape.Td.within(start.Td > 0 || !shape.has_derivative ? start.Td : kTdOverTi * start.Ti);
        // The first loop's frequencies are used for all later ones.
        Search local(plants, shape, limits, shape.law(std::abs(start.gain), start.Ti, start.Td));
        const auto take = [&](const Settings& found) {
            if (std::isfinite(found.load_IAE) && (!best || found.load_IAE < best->load_IAE)) best = found;
        };
        take(TimesSearch(local, shape, start).best(reach, control.stop));
        if (reach == Reach::wide &&
            std::ranges::any_of(plants, [](const auto* plant) { return is_resonant(*plant); })) {
            std::optional<Settings> other;
            for (const Settings& valley : valleys(local, shape, start, control.stop)) {
                local.keep_margin(kMargins[0]);
                const Settings found = TimesSearch(local, shape, valley).best(Reach::near, control.stop);
                if (!other || found.load_IAE < other->load_IAE) other = found;
            }
            if (other && std::isfinite(other->load_IAE) &&
                (!best || other->load_IAE < best->load_IAE * (1 - kMinValleyGain))) {
                local.keep_margin(kMargins[0]);
                take(TimesSearch(local, shape, *other).best(reach, control.stop));
            }
        }
        if (control.stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The job was cancelled."};
    }
    return best ? Expected<Settings>(*best) : Expected<Settings>(none(limits));
}

}  // namespace tunewright::device
