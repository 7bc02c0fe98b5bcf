#include "engine/tuning/device/largest_gain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/loop/sampled/sampled_loop.h"
#include "engine/numerics/optimise/line_search.h"

namespace tunewright::device {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGainInset = 1 - 1e-9;    // of a limit's gain, so that the limit itself holds despite rounding
constexpr double kIntervalOverlap = 1e-9;  // relative overlap of a refined interval with the grid's
constexpr double kGapProbe = 0.999;        // of a gap's upper end: the gain at which its stability is checked

struct Range {
    double from = kInfinity, to = kInfinity;
    bool empty() const { return !(from < to); }
};

/// The values k > 0 with a k^2 + 2 b k + c < 0, for either sign of c.
Range negative(double a, double b, double c) {
    if (a == 0) {
        if (b == 0) return {};
        const double root = -0.5 * c / b;
        return b > 0 ? Range{0, root} : Range{std::max(root, 0.0), kInfinity};
    }
    const double discriminant = b * b - a * c;
    if (!(discriminant > 0)) return a > 0 ? Range{} : Range{0, kInfinity};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    double low = q / a, high = q == 0 ? 0 : c / q;
    if (low > high) std::swap(low, high);
    if (a > 0) return high > 0 ? Range{std::max(low, 0.0), high} : Range{};
    // It is positive between the roots; beyond them the gain is too large.
    return high > 0 ? Range{high, kInfinity} : Range{0, kInfinity};
}

struct Forbidden {
    Range S, T, CS;
};

Forbidden forbidden_at(std::complex<double> G, std::complex<double> C, const PeakLimits& limits) {
    const double GG = std::norm(G), re = G.real(), s = 1 / (limits.Ms * limits.Ms), t = limits.Mt * limits.Mt;
    Forbidden f;
    f.S = negative(GG, re, 1 - s);
    f.T = negative(GG * (t - 1), t * re, t);
    if (limits.Mks) {
        const double m = *limits.Mks * *limits.Mks;
        f.CS = negative(m * GG - std::norm(C), m * re, m);
    }
    return f;
}

double first_of(const Forbidden& f) {
    double first = kInfinity;
    for (const Range& range : {f.S, f.T, f.CS})
        if (!range.empty()) first = std::min(first, range.from);
    return first;
}

/// The end of the interval of forbidden low gains; 0 if nothing, or everything above, is forbidden.
double last_of(const Forbidden& f) {
    double last = 0;
    for (const Range& range : {f.S, f.T, f.CS})
        if (!range.empty() && range.to < kInfinity) last = std::max(last, range.to);
    return last;
}

}  // namespace

GainLimiter::GainLimiter(const LinearPlant& plant, const Law& law)
    : plant_(&plant), omega_(frequencies_of(plant, law)) {
    if (law.Ts > 0) held_.emplace(plant, law.Ts, law.computation_delay);
    // Twice as dense as the first loop's own grid, because it must also serve later loops.
    std::vector<double> dense;
    for (std::size_t i = 0; i < omega_.size(); ++i) {
        if (i > 0) dense.push_back(std::sqrt(omega_[i - 1] * omega_[i]));
        dense.push_back(omega_[i]);
    }
    omega_ = std::move(dense);
    for (const double omega : omega_) P_.push_back(P(omega));
    G_.resize(P_.size());
}

std::vector<GainLimiter::Interval> GainLimiter::forbidden(const std::function<std::complex<double>(double)>& unit,
                                                          const PeakLimits& limits) {
    const auto at = [&](double omega) {
        const std::complex<double> C = unit(omega);
        return forbidden_at(P(omega) * C, C, limits);
    };
    std::vector<Interval> all;
    std::vector<double> first(omega_.size()), last(omega_.size());
    std::optional<Forbidden> before;
    for (std::size_t i = 0; i < omega_.size(); ++i) {
        const std::complex<double> C = unit(omega_[i]), G = G_[i] = P_[i] * C;
        if (!std::isfinite(std::norm(G))) {
            first[i] = kInfinity;
            before.reset();
            continue;
        }
        const Forbidden f = forbidden_at(G, C, limits);
        for (const auto part : {&Forbidden::S, &Forbidden::T, &Forbidden::CS}) {
            const Range& here = f.*part;
            if (here.empty()) continue;
            // Between two frequencies an interval moves continuously and forbids every gain that it passes.
            const Range past = before ? (*before).*part : Range{};
            // Below the first frequency, the two integrators of plant and controller extend the interval to 0.
            const double first_from = i == 0 ? 0 : here.from;
            all.push_back({past.empty() ? first_from : std::min(here.from, past.from),
                           past.empty() ? here.to : std::max(here.to, past.to), omega_[i]});
        }
        first[i] = first_of(f);
        last[i] = last_of(f);
        before = f;
    }
    // Between two frequencies an interval may begin lower or end higher than at either: refined where the grid has a
    // local extreme.
    for (std::size_t i = 1; i + 1 < omega_.size(); ++i) {
        if (last[i] > 0 && last[i] >= last[i - 1] && last[i] >= last[i + 1]) {
            const auto f = [&](double omega) { return last_of(at(omega)); };
            const Maximum max = log_maximum(f, omega_[i - 1], {omega_[i], last[i]}, omega_[i + 1]);
            all.push_back({last[i] * (1 - kIntervalOverlap), max.value, max.x});
        }
        if (!(first[i] < kInfinity) || first[i] > first[i - 1] || first[i] > first[i + 1] || first[i] == 0) continue;
        const auto f = [&](double omega) { return 1 / first_of(at(omega)); };
        const Maximum min = log_maximum(f, omega_[i - 1], {omega_[i], 1 / first[i]}, omega_[i + 1]);
        if (min.value > 0) all.push_back({1 / min.value, first[i] * (1 + kIntervalOverlap), min.x});
    }
    std::sort(all.begin(), all.end(), [](const Interval& a, const Interval& b) { return a.from < b.from; });
    std::vector<Interval> joined;
    for (const Interval& next : all) {
        if (!joined.empty() && next.from <= joined.back().to)
            joined.back().to = std::max(joined.back().to, next.to);
        else
            joined.push_back(next);
    }
    return joined;
}

bool GainLimiter::is_stable(double gain, const Law& law) const {
    if (!held_) return device::is_stable(*plant_, law);
    LoopGrid along;
    // The first loop's own grid: what it leaves open is followed with further points.
    for (std::size_t i = 0; i < omega_.size(); i += 2) {
        along.omega.push_back(omega_[i]);
        along.point.push_back({gain * G_[i], 0, 0, 0});
    }
    return count_unstable_poles(SampledLoop(*held_, law), along).stable();
}

std::optional<double> largest_gain(std::vector<GainLimiter>& plants, const std::function<Law(double k)>& law_at,
                                   const PeakLimits& limits, double max) {
    const Law unit_law = law_at(1);
    const auto unit = [&](double omega) { return response_of(unit_law, omega); };
    std::vector<GainLimiter::Interval> all;
    for (GainLimiter& plant : plants) {
        const auto some = plant.forbidden(unit, limits);
        all.insert(all.end(), some.begin(), some.end());
    }
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
    std::vector<double> gains;  // the largest gain of each gap
    double reached = 0;
    for (const auto& interval : all) {
        if (interval.from > reached && reached < max) gains.push_back(std::min(interval.from, max));
        reached = std::max(reached, interval.to);
    }
    for (auto gain = gains.rbegin(); gain != gains.rend(); ++gain) {
        const bool whole = *gain < max;
        const double probed = whole ? kGapProbe * *gain : *gain;
        const bool stable = std::ranges::all_of(
            plants, [&](const GainLimiter& plant) { return plant.is_stable(probed, law_at(probed)); });
        if (stable) return whole ? kGainInset * *gain : *gain;
    }
    return std::nullopt;
}

}  // namespace tunewright::device
