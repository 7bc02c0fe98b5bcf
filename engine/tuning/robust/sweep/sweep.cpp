#include "engine/tuning/robust/sweep/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/numerics/fast_complex.h"
#include "engine/tuning/robust/sweep/encirclements.h"

namespace tunewright::robust {
namespace {

using Complex = std::complex<double>;

constexpr int kPointsPerDecade = 40;
constexpr double kDecades = 3;      // decades below and above the reference
constexpr int kTurnsResolved = 24;  // turns of the dead time that are resolved
constexpr int kPointsPerTurn = 20;
constexpr double kFilterDecade = 30;  // multiple of 1/Tf: above it a fixed filter has made the loop small
constexpr double kTiedDecade = 10;    // multiple of 1/(Tf of the least Td)
constexpr double kMaxFrequencyOverFastestRoot =
    3;  // multiple of the plant's fastest root: there it falls with its final slope
constexpr double kMaxFrequencyRatio = 1e12;  // multiple of the reference
constexpr double kMaxResonantDamping = 0.3;  // damping below which a root has its own grid points
constexpr double kMinWidth = 1e-5;           // relative width of a resonance
constexpr int kResonancePoints = 12;         // to either side, with growing distances
constexpr double kResonanceGrowth = 1.17;    // ratio of successive distances, up to the spacing of the grid's own
                                             // points
constexpr double kLogPeakMargin = 0.05;  // in ln: grid points this far below the threshold may be next to a peak above
                                         // it
constexpr int kMaxParabolas = 6;         // parabolas for one peak; three are usual
constexpr double kParabolaEdge = 0.02;   // of its interval: minimal distance of a parabola's maximum from the ends
constexpr double kLogFrequencyTolerance = 1e-7;  // in ln omega: gives an error of 1e-14 in ln M
constexpr double kLogPeakTolerance = 1e-10;      // ln M
constexpr double kMinRelevantLogPeak = -0.05;    // ln M: a lower peak limits no step and needs no further refinement
constexpr double kLogPeakToleranceBelow = 1e-6;  // ln M
constexpr double kLogParabolaMargin = 0.03;      // in ln M: how much a peak may exceed the maximum of the first
                                                 // parabola
constexpr double kUnboundedLogRatio = 50;        // stands for ln of an unbounded ratio
constexpr double kMaxChange =
    0.5;  // distance between neighbours of L over its distance from -1: small enough that nothing hides between them
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double fastest_root(const LinearPlant& plant) {
    double fastest = 0;
    for (const auto pole : plant.poles()) fastest = std::max(fastest, std::abs(pole));
    for (const auto zero : plant.zeros()) fastest = std::max(fastest, std::abs(zero));
    return fastest;
}

std::vector<double> frequencies(const DesignProblem& problem, const LinearPlant& plant, double reference,
                                double resolved_to) {
    const double L = plant.dead_time();
    double high = reference * std::pow(10, kDecades);
    if (problem.filter.Tf && *problem.filter.Tf > 0) high = std::max(high, kFilterDecade / *problem.filter.Tf);
    // If the plant's gain does not fall, only a filter tied to Td makes the loop small, and |C S| has a peak near 1/Tf
    // on any plant: the grid extends beyond 1/Tf of the shortest filter, that of the least Td.
    double ended = kInfinity;
    if (problem.pid && problem.filter.Tf_over_Td)
        ended = kTiedDecade * reference / (*problem.filter.Tf_over_Td * kMinTd);
    if (std::isfinite(ended) && (plant.pole_excess() == 0 || problem.limits.Mks)) high = std::max(high, ended);
    // The plant's gain may stay constant up to its fastest lag, and an unfiltered derivative makes L grow there.
    high = std::max(
        high, std::min({ended, kMaxFrequencyOverFastestRoot * fastest_root(plant), kMaxFrequencyRatio * reference}));
    const double low = reference * std::pow(10, -kDecades), ratio = std::pow(10, 1.0 / kPointsPerDecade);
    const double spacing = L > 0 ? 2 * std::numbers::pi / (kPointsPerTurn * L) : kInfinity;
    std::vector<double> omega;
    for (double w = low; w < high;) {
        omega.push_back(w);
        w = w < resolved_to ? std::min(w * ratio, w + spacing) : w * ratio;
    }
    const auto add_resonance = [&](Complex root) {
        if (root.imag() <= 0 || std::abs(root.real()) > kMaxResonantDamping * std::abs(root)) return;
        const double centre = std::abs(root), width = std::max(std::abs(root.real()), kMinWidth * centre);
        const auto add = [&](double w) {
            if (w > low && w < std::min(high, resolved_to)) omega.push_back(w);
        };
        for (int k = -kResonancePoints; k <= kResonancePoints; ++k)
            add(centre + width * k * std::abs(k) / kResonancePoints);
        // L may cross 1 far out on the flanks of a high resonance.
        const double nearest = std::min((ratio - 1) * centre, spacing);
        for (double far = kResonanceGrowth * kResonancePoints * width; far < nearest; far *= kResonanceGrowth) {
            add(centre - far);
            add(centre + far);
        }
    };
    for (const auto pole : plant.poles()) add_resonance(pole);
    for (const auto zero : plant.zeros()) add_resonance(zero);
    if (std::ranges::adjacent_find(omega, std::greater_equal()) == omega.end()) return omega;
    std::sort(omega.begin(), omega.end());
    omega.erase(std::unique(omega.begin(), omega.end()), omega.end());
    return omega;
}

/// ln of the constraint's ratio at a frequency, from L and C.
double constraint_value(ConstraintKind kind, Complex L, Complex C, const PeakLimits& limits, double centre,
                        double radius) {
    switch (kind) {
        case ConstraintKind::S: return -std::log(limits.Ms * magnitude(1.0 + L));
        case ConstraintKind::T: return std::log(magnitude(L) / (magnitude(1.0 + L) * limits.Mt));
        case ConstraintKind::CS: return std::log(magnitude(C) / (magnitude(1.0 + L) * *limits.Mks));
        case ConstraintKind::circle: return std::log(radius / magnitude(L - centre));
    }
    return 0;
}

}  // namespace

Sweep::Sweep(const DesignProblem& problem, double reference) : problem_(problem), reference_(reference) {
    if (problem.measured) curves_.push_back(measured_curve());
    for (std::size_t i = 0; !problem.measured && i < problem.plants(); ++i) curves_.push_back(curve_of(i));
    for (Curve& curve : curves_) complete(curve);
    // The smallest circle around both: from -Mt/(Mt - 1) to -1 + 1/Ms on the real axis.
    const double left = -problem.limits.Mt / (problem.limits.Mt - 1), right = -1 + 1 / problem.limits.Ms;
    circle_ = {.centre = 0.5 * (left + right), .radius = 0.5 * (right - left)};
}

Sweep::Curve Sweep::curve_of(std::size_t index) const {
    Curve curve;
    const LinearPlant& plant = problem_.plant_at(index);
    curve.plant = &plant;
    curve.index = index;
    if (plant.dead_time() > 0) curve.resolved_to = kTurnsResolved * 2 * std::numbers::pi / plant.dead_time();
    const std::vector<double> omega = frequencies(problem_, plant, reference_, curve.resolved_to);
    const std::vector<Complex> responses = plant.at(omega);
    for (auto* kept : {&curve.omega, &curve.P_re, &curve.P_im, &curve.log_omega}) kept->reserve(omega.size());
    for (std::size_t i = 0; i < omega.size(); ++i) {
        const Complex P = responses[i];
        // At an undamped pole P is infinite; the neighbours show the same.
        if (!std::isfinite(P.real()) || !std::isfinite(P.imag())) continue;
        curve.omega.push_back(omega[i]);
        curve.P_re.push_back(P.real());
        curve.P_im.push_back(P.imag());
    }
    return curve;
}

/// The band alone. Beyond its end, |L| of the end at the worst phase is a bound, as for a dead time that turns too fast
/// for the grid.
Sweep::Curve Sweep::measured_curve() const {
    Curve curve;
    curve.resolved_to = problem_.measured->high();
    const double ratio = std::pow(10, 1.0 / kPointsPerDecade);
    for (const double measured : problem_.measured->omega()) {
        const double before = curve.omega.empty() ? measured : curve.omega.back();
        const int parts = std::max(1, static_cast<int>(std::ceil(std::log(measured / before) / std::log(ratio))));
        for (int k = curve.omega.empty() ? parts : 1; k < parts; ++k)
            curve.omega.push_back(before * std::pow(measured / before, double(k) / parts));
        curve.omega.push_back(measured);
    }
    for (const double w : curve.omega) {
        const Complex P = plant_at(curve, w);
        curve.P_re.push_back(P.real());
        curve.P_im.push_back(P.imag());
    }
    return curve;
}

Complex Sweep::plant_at(const Curve& curve, double omega) const {
    return curve.plant ? curve.plant->at({0, omega}) : problem_.measured->at(omega);
}

void Sweep::complete(Curve& curve) const {
    const auto first = std::lower_bound(curve.omega.begin(), curve.omega.end(), curve.resolved_to);
    curve.resolved = static_cast<std::size_t>(first - curve.omega.begin());
    for (auto* scratch : {&curve.S, &curve.T, &curve.L_re, &curve.L_im, &curve.lower, &curve.upper, &curve.other_lower,
                          &curve.other_upper})
        scratch->resize(curve.omega.size());
    if (problem_.limits.Mks) curve.CS.resize(curve.omega.size());
    if (problem_.limits.m_circle) curve.circle.resize(curve.omega.size());
    for (const double omega : curve.omega) curve.log_omega.push_back(std::log(omega));
    if (curve.plant == nullptr) return;
    curve.phase_at_low = phase_from_rest(*curve.plant, curve.omega.front());
    curve.unstable_poles = curve.plant->unstable_poles();
}

LoopGains Sweep::gains(const DesignPoint& x) const {
    const IdealPid pid = controller_at(problem_, x);
    return {pid.Kp, pid.Kp / pid.Ti, pid.Kp * pid.Td, pid.filter.Tf};
}

/// The exact value of the constraint at one frequency.
double Sweep::value(const Curve& curve, ConstraintKind kind, const LoopGains& c, double omega) const {
    const Complex C = controller_response(c, omega);
    return constraint_value(kind, worst_phase(curve, plant_at(curve, omega) * C, omega), C, problem_.limits,
                            circle_.centre, circle_.radius);
}

Complex Sweep::worst_phase(const Curve& curve, Complex L, double omega) const {
    if (omega < curve.resolved_to) return L;
    return -std::min(std::abs(L), 1 - kMinDistance);  // reached within one turn of the dead time
}

std::array<double, 3> Sweep::gradient(const Curve& curve, ConstraintKind kind, const LoopGains& c, double omega) const {
    const Complex s(0, omega), integral(0, -c.Ki / omega), derivative = c.Kd * s, sum = c.Kp + integral + derivative;
    const Complex filter = 1.0 + c.Tf * s * (1.0 + 0.5 * c.Tf * s);
    // d ln C by ln Kp, ln Ti and ln Td.
    std::array<Complex, 3> dC = {1.0, -quotient(integral, sum), quotient(derivative, sum)};
    if (problem_.filter.Tf_over_Td) dC[2] -= quotient(c.Tf * s * (1.0 + c.Tf * s), filter);
    const Complex L = worst_phase(curve, plant_at(curve, omega) * quotient(sum, filter), omega),
                  S = quotient(1.0, 1.0 + L), T = L * S;
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        switch (kind) {
            case ConstraintKind::S: result[i] = -(T * dC[i]).real(); break;
            case ConstraintKind::T:
            case ConstraintKind::CS: result[i] = (S * dC[i]).real(); break;
            case ConstraintKind::circle: result[i] = -quotient(L * dC[i], L - circle_.centre).real(); break;
        }
    }
    if (!problem_.pid) result[2] = 0;
    return result;
}

/// The local maximum near a grid point, by parabolas through three points of ln(value) over ln(omega), repeated around
/// the best point until it no longer moves. Empty if the first parabola shows that it is below the threshold.
std::optional<Sweep::Top> Sweep::top_near(const Curve& curve, std::size_t i, const std::vector<double>& level,
                                          ConstraintKind kind, const LoopGains& c, double threshold) const {
    const auto at = [&](std::size_t k) { return Top{curve.log_omega[k], 0.5 * std::log(level[k])}; };
    Top left = at(i - 1), best = at(i), right = at(i + 1);
    for (int k = 0; k < kMaxParabolas; ++k) {
        const double rise = (best.value - left.value) / (best.log_omega - left.log_omega),
                     fall = (right.value - best.value) / (right.log_omega - best.log_omega),
                     bend = (fall - rise) / (right.log_omega - left.log_omega);
        if (!(bend < 0)) break;
        const double middle = 0.5 * (left.log_omega + best.log_omega) - 0.5 * rise / bend;
        const double log_omega = std::clamp(middle, left.log_omega + kParabolaEdge * (best.log_omega - left.log_omega),
                                            right.log_omega - kParabolaEdge * (right.log_omega - best.log_omega));
        const double step = log_omega - best.log_omega;
        if (k == 0 && best.value - bend * step * step < threshold - kLogParabolaMargin) return std::nullopt;
        if (std::abs(step) < kLogFrequencyTolerance) break;
        const Top here{log_omega, value(curve, kind, c, std::exp(log_omega))};
        const double gain = here.value - best.value;
        if (gain >= 0) {
            (step > 0 ? left : right) = best;
            best = here;
        } else {
            (step > 0 ? right : left) = here;
        }
        if (std::abs(gain) < (best.value < kMinRelevantLogPeak ? kLogPeakToleranceBelow : kLogPeakTolerance)) break;
    }
    return best;
}

/// `level` has squared ratios: the limit is at 1.
void Sweep::add_peaks(const Curve& curve, ConstraintKind kind, const std::vector<double>& level, const LoopGains& c,
                      double threshold, std::vector<ActivePeak>& found) const {
    const std::size_t n = level.size();
    local_maxima(level, std::exp(2 * (threshold - kLogPeakMargin)), tops_);
    for (const std::size_t i : tops_) {
        const bool first = i == 0, last = i + 1 == n;
        ActivePeak peak{.kind = kind, .plant = curve.index, .omega = curve.omega[i], .value = 0.5 * std::log(level[i])};
        if (i != curve.resolved && !first && !last) {
            const auto top = top_near(curve, i, level, kind, c, threshold);
            if (!top) continue;
            peak.omega = std::exp(top->log_omega);
            peak.value = top->value;
        }
        if (peak.value < threshold) continue;
        peak.gradient = gradient(curve, kind, c, peak.omega);
        found.push_back(peak);
    }
}

void Sweep::add_limits(const Curve& curve, const LoopGains& c, double threshold, std::vector<ActivePeak>& found) const {
    // Without a filter, a direct loop gain q remains at infinite frequency.
    if (c.Tf > 0 || curve.plant == nullptr) return;
    const int excess = curve.plant->pole_excess() - (problem_.pid ? 1 : 0);
    if (excess > 0) return;
    const double q = curve.plant->gain() * (problem_.pid ? c.Kd : c.Kp);
    const bool turning = curve.plant->dead_time() > 0;
    const double nearest = turning ? 1 - std::abs(q) : std::abs(1 + q);
    const std::size_t gain_index = problem_.pid ? 2 : 0;
    const auto add = [&](ConstraintKind kind, double value, double slope) {
        if (!(value >= threshold)) return;
        ActivePeak peak{
            .kind = kind, .plant = curve.index, .omega = kInfinity, .value = std::min(value, kUnboundedLogRatio)};
        peak.gradient[0] = slope;
        if (gain_index == 2) peak.gradient[2] = slope;
        found.push_back(peak);
    };
    const double size = std::abs(q);
    add(ConstraintKind::S, nearest > 0 ? -std::log(problem_.limits.Ms * nearest) : kUnboundedLogRatio,
        nearest > 0 ? size / nearest : kUnboundedLogRatio);
    add(ConstraintKind::T, nearest > 0 ? std::log(size / nearest / problem_.limits.Mt) : kUnboundedLogRatio,
        nearest > 0 ? 1 / nearest : kUnboundedLogRatio);
}

/// Squared ratios to the limits at every frequency of the grid.
void Sweep::fill_levels(Curve& curve, const LoopGains& c) const {
    const PeakLimits& limits = problem_.limits;
    const InverseLimits inverse{.S = 1 / (limits.Ms * limits.Ms),
                                .T = 1 / (limits.Mt * limits.Mt),
                                .CS = limits.Mks ? 1 / (*limits.Mks * *limits.Mks) : 0};
    if (limits.m_circle) circle_levels(curve.followed(), c, circle_, curve.circle.data());
    if (!limits.m_circle || limits.Mks) {
        const std::size_t turning = curve.resolved;
        double* CS = limits.Mks ? curve.CS.data() : nullptr;
        peak_levels(curve.followed(), c, inverse, curve.S.data(), curve.T.data(), CS);
        turning_levels(curve.turning(), c, inverse, curve.S.data() + turning, curve.T.data() + turning,
                       CS != nullptr ? CS + turning : nullptr);
    }
    for (std::size_t i = curve.resolved; limits.m_circle && i < curve.omega.size(); ++i) {
        const Complex C = controller_response(c, curve.omega[i]);
        const double size = magnitude(C) * magnitude({curve.P_re[i], curve.P_im[i]});
        const double to_circle = std::abs(circle_.centre) - size;
        curve.circle[i] =
            circle_.radius * circle_.radius / std::max(to_circle * to_circle, kMinDistance * kMinDistance);
    }
}

std::vector<ActivePeak> Sweep::peaks(const DesignPoint& x, double threshold) const {
    const LoopGains c = gains(x);
    std::vector<ActivePeak> found;
    for (Curve& curve : curves_) {
        fill_levels(curve, c);
        if (problem_.limits.m_circle) {
            add_peaks(curve, ConstraintKind::circle, curve.circle, c, threshold, found);
        } else {
            add_peaks(curve, ConstraintKind::S, curve.S, c, threshold, found);
            add_peaks(curve, ConstraintKind::T, curve.T, c, threshold, found);
        }
        if (problem_.limits.Mks) add_peaks(curve, ConstraintKind::CS, curve.CS, c, threshold, found);
        add_limits(curve, c, threshold, found);
    }
    std::sort(found.begin(), found.end(), [](const ActivePeak& a, const ActivePeak& b) { return a.value > b.value; });
    return found;
}

bool Sweep::stays_stable(const DesignPoint& from, const DesignPoint& to) const {
    const LoopGains a = gains(from), b = gains(to);
    if (!(std::abs(b.Ki / a.Ki - 1) < kMaxChange)) return false;  // at rest, with the integral
    return std::ranges::all_of(curves_, [&](const Curve& curve) {
        return curve.plant != nullptr && moves_less(curve.followed(), a, b, kMaxChange, Phase::as_it_is) &&
               moves_less(curve.turning(), a, b, kMaxChange, Phase::worst);
    });
}

namespace {

constexpr double kMinEntranceModulus = 2;    // |L| where a loop enters the grid: it has not been near -1 before
constexpr std::size_t kUsualIntervals = 64;  // intervals of one plant; memory for them is reserved

/// Adds the intervals of positive numbers; those of neighbouring frequencies, which nearly always overlap, are merged
/// before they are sorted with the others.
void add_joined(const Intervals& intervals, std::vector<GainGap>& out) {
    const double *lower = intervals.lower.data(), *upper = intervals.upper.data();
    const std::size_t n = intervals.upper.size();
    for (std::size_t i = 0; i < n;) {
        if (!(upper[i] > 0)) {
            ++i;
            continue;
        }
        double min = lower[i], max = upper[i];
        for (++i; i < n && lower[i] <= max && upper[i] >= min && upper[i] > 0; ++i) {
            min = lower[i] < min ? lower[i] : min;
            max = upper[i] > max ? upper[i] : max;
        }
        out.push_back({.lower = std::max(0.0, min), .upper = max});
    }
}

/// The gaps between the forbidden intervals, in ascending order. Sorts `forbidden`.
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
    const PeakLimits& limits = problem_.limits;
    const double Mt2 = limits.Mt * limits.Mt;
    const Circle of_S{.centre = -1, .radius = 1 / limits.Ms},
        of_T{.centre = -Mt2 / (Mt2 - 1), .radius = limits.Mt / (Mt2 - 1)};
    const Intervals first{curve.lower, curve.upper}, second{curve.other_lower, curve.other_upper};
    forbidden_factors(curve.L_re, curve.L_im, limits.m_circle ? circle_ : of_S, limits.m_circle ? circle_ : of_T, first,
                      second);
    for (const Intervals& intervals : {first, second}) add_joined(intervals, forbidden);
}

/// Adds the intervals that Mks forbids: K^2 |C|^2 <= Mks^2 |1 + K L|^2.
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

/// The start of the curve at frequency 0, where the integral makes L infinite: on the right or on the left; and its
/// phase at the grid's lowest frequency, followed from there.
Sweep::Entrance Sweep::entrance(const Curve& curve, const LoopGains& c) const {
    const double w = curve.omega.front();
    const double lead = std::atan((c.Kd * w - c.Ki / w) / c.Kp),
                 lag = std::atan2(w * c.Tf, 1 - 0.5 * w * w * c.Tf * c.Tf);
    const bool from_left = problem_.sign * curve.plant->low_frequency_gain() < 0;
    return {.from_left = from_left,
            .phase = (from_left ? std::numbers::pi : 0) + *curve.phase_at_low + lead - lag,
            .size = magnitude({curve.L_re.front(), curve.L_im.front()})};
}

/// Twice the number of crossings of the negative real axis between frequency 0 and the grid's lowest frequency, for the
/// gain k; a start on the left counts as half a crossing. Empty if the curve may have crossed between -1 and 0 below
/// the grid.
std::optional<int> Sweep::crossed_below(const Entrance& in, double k) {
    using std::numbers::pi;
    if (std::abs(in.phase) < pi) return in.from_left ? 1 : 0;
    if (std::abs(in.phase) > 3 * pi || k * in.size < kMinEntranceModulus) return std::nullopt;
    return (in.from_left ? 1 : 0) + (in.phase < 0 ? 2 : -2);
}

/// Forbids gains that are so low that, below the grid, two integrators without enough lead take the loop closer to -1
/// than the limit on |S| allows.
void Sweep::forbid_below(const Curve& curve, const LoopGains& c, std::vector<GainGap>& forbidden) const {
    if (!curve.phase_at_low || curve.plant->integrators() != 1) return;
    const Entrance in = entrance(curve, c);
    if (!in.from_left && in.size > 0 && std::abs(in.phase + std::numbers::pi) < 0.5 / problem_.limits.Ms)
        forbidden.push_back({.lower = 0, .upper = 1 / in.size});
}

/// A curve from frequency 0, and the stability of the loop with the gain k that follows from it.
struct Sweep::GainCourse {
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

void Sweep::find_stability(const LoopGains& c, std::vector<GainGap>& gaps) const {
    if (!std::ranges::all_of(curves_, [](const Curve& curve) { return curve.phase_at_low.has_value(); })) return;
    std::vector<GainCourse> courses;  // for every curve, computed at the first use
    for (GainGap& gap : gaps) {
        if (gap.upper == kInfinity) continue;
        gap.stable = gap.verified = gap.lower == 0 && stable_at_low_gain();
        if (gap.verified) continue;
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
    find_stability(c, gaps);
    return gaps;
}

}  // namespace tunewright::robust
