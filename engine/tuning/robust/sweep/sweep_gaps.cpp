// Which gains a sweep's plants leave for given times, and whether the loop is stable with them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/numerics/fast_complex.h"
#include "engine/tuning/robust/sweep/encirclements.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {
namespace {

constexpr double kFarOutside = 2;  // |L| where a loop enters the grid: it has not been near -1 before
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kUsualIntervals = 64;  // of one plant: room for them is taken at once

/// Adds the intervals of positive numbers; those of neighbouring frequencies, which nearly always overlap, are joined
/// before they are sorted with others.
void add_joined(const Intervals& intervals, std::vector<GainGap>& out) {
    const double *lower = intervals.lower.data(), *upper = intervals.upper.data();
    const std::size_t n = intervals.upper.size();
    for (std::size_t i = 0; i < n;) {
        if (!(upper[i] > 0)) {
            ++i;
            continue;
        }
        double least = lower[i], most = upper[i];
        for (++i; i < n && lower[i] <= most && upper[i] >= least && upper[i] > 0; ++i) {
            least = lower[i] < least ? lower[i] : least;
            most = upper[i] > most ? upper[i] : most;
        }
        out.push_back({.lower = std::max(0.0, least), .upper = most});
    }
}

/// What the forbidden intervals leave, in ascending order. `forbidden` is sorted on the way.
std::vector<GainGap> gaps_between(std::vector<GainGap>& forbidden) {
    std::sort(forbidden.begin(), forbidden.end(), [](const GainGap& a, const GainGap& b) { return a.lower < b.lower; });
    std::vector<GainGap> gaps;
    gaps.reserve(forbidden.size() + 1);
    double reached = 0;
    for (const auto& interval : forbidden) {
        if (interval.lower > reached) gaps.push_back({.lower = reached, .upper = interval.lower});
        reached = std::max(reached, interval.upper);
    }
    if (reached < kInfinity) gaps.push_back({.lower = reached, .upper = kInfinity});
    return gaps;
}

}  // namespace

double GainGap::middle() const { return lower > 0 ? std::sqrt(lower * upper) : 0.5 * upper; }

void Sweep::fill_open_loop(Curve& curve, const LoopGains& c) const {
    double *re = curve.L_re.data(), *im = curve.L_im.data();
    open_loops(curve.followed(), c, Phase::as_it_is, re, im);
    open_loops(curve.turning(), c, Phase::worst, re + curve.resolved, im + curve.resolved);
}

/// Adds the intervals of |Kp| that the circles forbid on one plant.
void Sweep::forbid(Curve& curve, std::vector<GainGap>& forbidden) const {
    const Limits& limits = problem_.limits;
    const double Mt2 = limits.Mt * limits.Mt;
    const Circle of_S{.centre = -1, .radius = 1 / limits.Ms},
        of_T{.centre = -Mt2 / (Mt2 - 1), .radius = limits.Mt / (Mt2 - 1)};
    const Intervals first{curve.lower, curve.upper}, second{curve.other_lower, curve.other_upper};
    forbidden_factors(curve.L_re, curve.L_im, limits.m_circle ? circle_ : of_S, limits.m_circle ? circle_ : of_T, first,
                      second);
    for (const Intervals& intervals : {first, second}) add_joined(intervals, forbidden);
}

/// Those that Mks forbids: K^2 |C|^2 <= Mks^2 |1 + K L|^2.
void Sweep::forbid_activity(const Curve& curve, const LoopGains& c, std::vector<GainGap>& forbidden) const {
    const double M = *problem_.limits.Mks * *problem_.limits.Mks;
    for (std::size_t i = 0; i < curve.omega.size(); ++i) {
        const double re = curve.L_re[i], im = curve.L_im[i];
        const std::complex<double> C = controller_response(c, curve.omega[i]);
        const double a = std::norm(C) - M * (re * re + im * im), b = M * re, discriminant = b * b + a * M;
        if (a > 0) forbidden.push_back({.lower = (b + std::sqrt(discriminant)) / a, .upper = kInfinity});
        if (a < 0 && discriminant > 0 && b < 0)
            forbidden.push_back(
                {.lower = (b + std::sqrt(discriminant)) / a, .upper = (b - std::sqrt(discriminant)) / a});
    }
}

/// Where the loop comes from at rest, the integral making L infinite: to the right, or to the left; and its phase at
/// the grid's lowest frequency, followed from there.
Sweep::Entrance Sweep::entrance(const Curve& curve, const LoopGains& c) const {
    const double w = curve.omega.front();
    const double lead = std::atan((c.Kd * w - c.Ki / w) / c.Kp),
                 lag = std::atan2(w * c.Tf, 1 - 0.5 * w * w * c.Tf * c.Tf);
    const bool from_left = problem_.sign * curve.plant->low_frequency_gain() < 0;
    return {.from_left = from_left,
            .phase = (from_left ? std::numbers::pi : 0) + *curve.phase_at_low + lead - lag,
            .size = magnitude({curve.L_re.front(), curve.L_im.front()})};
}

/// Twice the crossings of the negative real axis on the way from rest to the grid's lowest frequency, where the loop's
/// gain there is k; at rest to the left counts as half a crossing. Empty where the curve may have passed between -1 and
/// 0 before the grid takes over.
std::optional<int> Sweep::crossed_below(const Entrance& in, double k) {
    using std::numbers::pi;
    if (std::abs(in.phase) < pi) return in.from_left ? 1 : 0;
    if (std::abs(in.phase) > 3 * pi || k * in.size < kFarOutside) return std::nullopt;
    return (in.from_left ? 1 : 0) + (in.phase < 0 ? 2 : -2);
}

/// Gains so low that two integrators without enough lead take the loop past -1, nearer than the limit on |S| allows,
/// before the grid takes over.
void Sweep::forbid_below(const Curve& curve, const LoopGains& c, std::vector<GainGap>& forbidden) const {
    if (!curve.phase_at_low || curve.plant->integrators() != 1) return;
    const Entrance in = entrance(curve, c);
    if (!in.from_left && in.size > 0 && std::abs(in.phase + std::numbers::pi) < 0.5 / problem_.limits.Ms)
        forbidden.push_back({.lower = 0, .upper = 1 / in.size});
}

/// A curve from rest on, and what it says of the loop's stability with the gain k.
struct Sweep::Course {
    int unstable_poles;
    Entrance in;
    AxisCrossings crossings;

    std::optional<bool> stable(double k) const {
        const auto below = crossed_below(in, k), on_grid = crossings.beyond(k);
        if (!below || !on_grid) return std::nullopt;
        return unstable_poles + *below + 2 * *on_grid == 0;
    }
};

/// A stable plant with an integral of the right sign is stable at low gain.
bool Sweep::stable_at_low_gain() const {
    return std::ranges::all_of(curves_, [this](const Curve& curve) {
        return curve.phase_at_low && curve.unstable_poles == 0 && curve.plant->integrators() == 0 &&
               problem_.sign * curve.plant->low_frequency_gain() > 0;
    });
}

void Sweep::tell_stability(const LoopGains& c, std::vector<GainGap>& gaps) const {
    if (!std::ranges::all_of(curves_, [](const Curve& curve) { return curve.phase_at_low.has_value(); })) return;
    std::vector<Course> courses;  // of every curve, worked out once they are asked for
    for (GainGap& gap : gaps) {
        if (gap.upper == kInfinity) continue;
        gap.stable = gap.proved = gap.lower == 0 && stable_at_low_gain();
        if (gap.proved) continue;
        if (courses.empty())
            for (const Curve& curve : curves_)
                courses.push_back({curve.unstable_poles, entrance(curve, c), {curve.L_re, curve.L_im}});
        gap.stable = true;
        for (std::size_t i = 0; i < courses.size() && gap.stable == true; ++i)
            gap.stable = courses[i].stable(gap.middle());
    }
}

std::vector<GainGap> Sweep::gain_gaps(double Ti, double Td) const {
    const LoopGains c = gains({0, std::log(Ti), problem_.pid ? std::log(Td) : 0});
    std::vector<GainGap> forbidden;
    forbidden.reserve(kUsualIntervals * curves_.size());
    for (Curve& curve : curves_) {
        fill_open_loop(curve, c);
        forbid(curve, forbidden);
        forbid_below(curve, c, forbidden);
        if (problem_.limits.Mks) forbid_activity(curve, c, forbidden);
    }
    auto gaps = gaps_between(forbidden);
    tell_stability(c, gaps);
    return gaps;
}

}  // namespace tunewright::robust
