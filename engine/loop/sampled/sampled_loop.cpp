#include "engine/loop/sampled/sampled_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/loop/winding.h"
#include "engine/numerics/fast_complex.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr int kSparseDensity = 8;            // for |S| alone, whose own steps refine the grid
constexpr double kGridStep = 0.15;           // change of S between neighbours
constexpr double kMinFrequencyShare = 1e-3;  // of 1/Ts: frequency at which the integral's phase is read
constexpr double kLightDamping = 0.3;        // damping of a plant's pole that is a resonance, also when aliased below
                                             // pi/Ts
constexpr double kMinWidth = 1e-6;           // of a folded resonance, relative

constexpr double kFollowedTurn = 2;           // rad of z and of the dead time: in shorter turns no full turn is missed
constexpr double kMaxModulusBelowOne = 0.99;  // of |L| at both ends: 1 + L stays in the right half-plane
constexpr double kMaxAxisDistance = 1e-9;     // |1 + L| relative to 1 + |L|: a smaller value counts as a pole on the
                                              // circle
constexpr double kMinModulusAtPole = 1e10;    // of 1 + |L|: beyond it the distance to the pole is only rounding
constexpr double kMaxPole = 1e100;            // of a plant's pole: no law with finite numbers can stabilise it
constexpr int kMaxHalvings = 60;

Complex integral_part(const SampledPid& law, Complex difference, Complex back) {
    const Complex sum = quotient(law.gains.Ki * law.Ts, difference);
    switch (law.integral) {
        case IntegralRule::backward: return sum;
        case IntegralRule::forward: return sum * back;
        case IntegralRule::trapezoidal: return 0.5 * sum * (1.0 + back);
    }
    return 0;
}

Complex derivative_part(const SampledPid& law, Complex difference, Complex back, double x) {
    const double Ts = law.Ts, Kd = law.gains.Kd;
    const bool filtered = law.gains.filter.type == FilterType::derivative;
    const double Tf = filtered ? law.gains.filter.Tf : 0;
    switch (law.derivative) {
        case DerivativeRule::difference: return Kd * difference / Ts;
        case DerivativeRule::filtered_backward: return quotient(Kd * difference, Ts + Tf * difference);
        case DerivativeRule::filtered_forward:
            return filtered ? quotient(Kd * difference, Tf * difference + Ts * back) : Kd * difference / Ts;
        case DerivativeRule::filtered_trapezoidal:
            return filtered ? 2 * Kd * difference / (2 * Tf * difference + Ts * (1.0 + back)) : Kd * difference / Ts;
        case DerivativeRule::slope:
            return Kd * UnitCircle(law.slope_samples * x).one_minus_back / (law.slope_samples * Ts);
        case DerivativeRule::four_points: {
            const Complex cubed = back * back * back;
            return Kd * (3.0 * (1.0 - cubed) + back - back * back) / (10 * Ts);
        }
    }
    return 0;
}

Complex filter_part(const SampledPid& law, Complex difference) {
    const double ratio = law.gains.filter.Tf / law.Ts;
    const Complex lag = ratio * difference;  // s Tf by backward Euler
    switch (law.gains.filter.type) {
        case FilterType::measurement_first_order: return quotient(1.0, 1.0 + lag);
        case FilterType::measurement_second_order: return quotient(1.0, 1.0 + lag + 0.5 * product(lag, lag));
        default: return 1;
    }
}

// s = w/q, q = 1 + z^-1, in P, I, D and the filter together: at pi/Ts q is 0, where D alone would be infinite.
Complex whole_by_trapezoids_at(const SampledPid& law, Complex difference, Complex back) {
    const Complex q = 1.0 + back, w = 2.0 * difference / law.Ts, lag = law.gains.filter.Tf * w;
    Complex sum = law.gains.Kp;
    if (law.gains.Ki != 0) sum += integral_part(law, difference, back);
    if (law.gains.filter.type == FilterType::measurement_first_order) return (sum * q + law.gains.Kd * w) / (q + lag);
    return (sum * q + law.gains.Kd * w) * q / (q * q + lag * q + 0.5 * lag * lag);
}

// Pole of a derivative filter by the forward rule: outside the circle for Tf < Ts/2.
double forward_pole(const SampledPid& law) {
    const bool runs = law.derivative == DerivativeRule::filtered_forward &&
                      law.gains.filter.type == FilterType::derivative && law.gains.Kd != 0;
    return runs ? 1 - law.Ts / law.gains.filter.Tf : 0;
}

}  // namespace

Complex pulse_response(const SampledPid& law, double omega, const UnitCircle& z) {
    const Complex difference = z.one_minus_back, back = z.back;
    if (whole_by_trapezoids(law)) return whole_by_trapezoids_at(law, difference, back);
    Complex sum = law.gains.Kp;
    if (law.gains.Ki != 0) sum += integral_part(law, difference, back);
    if (law.gains.Kd != 0) sum += derivative_part(law, difference, back, omega * law.Ts);
    return sum * filter_part(law, difference);
}

LoopPoint SampledLoop::at(double omega) const {
    const UnitCircle z(omega * law_.Ts);
    const Complex C = pulse_response(law_, omega, z), L = plant_.at(omega, z) * C, S = quotient(1.0, 1.0 + L);
    if (!std::isfinite(magnitude(L))) return {L, 0, 1, 0};  // at a pole of the plant on the circle
    return {L, S, L * S, C * S};
}

double SampledLoop::highest_frequency() const { return std::numbers::pi / law_.Ts; }

bool SampledLoop::finite_at_zero() const { return law_.gains.Ki == 0 && plant_.plant().integrators() <= 0; }

Complex SampledLoop::open_loop(double omega) const {
    const UnitCircle z(omega * law_.Ts);
    return plant_.at(omega, z) * pulse_response(law_, omega, z);
}

LoopGrid SampledLoop::ends() const {
    LoopPoint zero{std::numeric_limits<double>::infinity(), 0, 1, 0};
    if (finite_at_zero())
        zero = at(0);
    else if (plant_.plant().integrators() <= 0)
        zero.CS = 1 / plant_.plant().low_frequency_gain();
    const double highest = highest_frequency();
    return {{0, highest}, {zero, at(highest)}};
}

LoopGrid make_loop_grid(const SampledLoop& loop, const Refinement& refinement, int density) {
    const LinearPlant& plant = loop.plant().plant();
    const double highest = loop.highest_frequency();
    std::vector<double> base = base_frequencies(
        plant, loop.law().gains, [&](double omega) { return loop.open_loop(std::min(omega, highest)); }, density,
        highest);
    for (const Complex pole : plant.poles()) {
        if (pole.imag() <= highest || std::abs(pole.real()) > kLightDamping * std::abs(pole)) continue;
        const double folded = std::abs(std::remainder(pole.imag(), 2 * highest));
        const double width = std::max(std::abs(pole.real()), kMinWidth * folded);
        for (const double offset : {-3.0, -1.0, -0.3, 0.0, 0.3, 1.0, 3.0}) base.push_back(folded + offset * width);
    }
    std::erase_if(base, [&](double omega) { return !(omega > 0 && omega < highest); });
    base.push_back(highest);
    if (base.size() < 2) base.push_back(kMinFrequencyShare * highest);
    std::sort(base.begin(), base.end());
    base.erase(std::unique(base.begin(), base.end()), base.end());
    return refined_grid([&](double omega) { return loop.at(omega); }, base, highest, refinement);
}

Peak SampledLoop::sensitivity_peak() const {
    const LoopGrid grid = refined_at_low_peak(*this, make_loop_grid(*this, kGridStep, kSparseDensity));
    if (!count_unstable_poles(*this, grid).stable()) return {std::numeric_limits<double>::infinity(), 0};
    return find_sensitivity_peak(*this, grid);
}

bool SampledLoop::keeps(double limit) const {
    const LoopGrid grid = refined_at_low_peak(*this, make_loop_grid(*this, {kGridStep, limit}, kSparseDensity), limit);
    if (std::ranges::any_of(grid.point, [=](const LoopPoint& point) { return magnitude(point.S) > limit; }))
        return false;
    return find_sensitivity_peak(*this, grid).value <= limit && count_unstable_poles(*this, grid).stable();
}

namespace {

/// q = prod (1 - p/z) (1 + L) over the open loop's poles that are outside the circle or close to it: the closed loop's
/// characteristic polynomial over a power of z. From omega = 0 to pi/Ts its argument falls by pi for each of its zeros
/// outside the circle.
class Characteristic {
public:
    explicit Characteristic(const SampledLoop& loop) : loop_(loop), poles_(loop.plant().poles()) {
        if (loop.law().gains.Ki != 0) poles_.emplace_back(1.0);
        if (const double pole = forward_pole(loop.law()); pole != 0) poles_.emplace_back(pole);
    }

    struct Value {
        double omega;
        Complex open, returned, q;  // q = open (1 + L), returned = 1 + L
        double size;                // 1 + |L|
        bool zero;                  // true: 1 + L is 0
    };
    Value at(double omega) const { return at(omega, loop_.open_loop(omega)); }
    Value at(double omega, Complex L) const {
        const UnitCircle z(omega * loop_.law().Ts);
        Complex open = 1;
        for (const Complex pole : poles_)
            open = product(open, pole == 1.0 ? z.one_minus_back : 1.0 - product(pole, z.back));
        const Complex returned = 1.0 + L;
        const double size = 1 + magnitude(L);
        return {omega, open, returned, product(open, returned), size, magnitude(returned) <= kMaxAxisDistance * size};
    }

    /// Turn of z and of the dead time from one to the other, rad.
    double turn(const Value& left, const Value& right) const {
        return loop_.turning_time() * (right.omega - left.omega);
    }

private:
    const SampledLoop& loop_;
    std::vector<Complex> poles_;
};

/// Follows q between two frequencies, halving the step until its turn is unambiguous. False: q is 0 there, or nearly 0.
bool follow(const Characteristic& q, Winding& winding, const Characteristic::Value& left,
            const Characteristic::Value& right, int depth = kMaxHalvings) {
    if (left.zero || right.zero) return false;
    // A full turn of the dead time in between would look like no turn.
    const bool followed = q.turn(left, right) <= kFollowedTurn;
    if (followed && Winding::is_short(left.q, right.q)) {
        winding.follow(right.q);
        return true;
    }
    // The turn of each factor alone may be unambiguous. If |L| < 1 from end to end, 1 + L stays in the right half-plane
    // whatever the dead time.
    const bool below_one = left.size < 1 + kMaxModulusBelowOne && right.size < 1 + kMaxModulusBelowOne;
    if ((below_one || (followed && Winding::is_short(left.returned, right.returned))) &&
        Winding::is_short(left.open, right.open)) {
        const Complex open = quotient(right.open, left.open), returned = quotient(right.returned, left.returned);
        winding.turn(turn_of(product(open, returned), open, returned), right.q);
        return true;
    }
    if (depth == 0) return false;
    const auto centre = q.at(std::sqrt(left.omega * right.omega));
    return follow(q, winding, left, centre, depth - 1) && follow(q, winding, centre, right, depth - 1);
}

}  // namespace

StabilityCount count_unstable_poles(const SampledLoop& loop) {
    return count_unstable_poles(loop, make_loop_grid(loop));
}

StabilityCount count_unstable_poles(const SampledLoop& loop, const LoopGrid& along) {
    const Characteristic q(loop);
    auto left = q.at(along.omega.front(), along.point.front().L);
    // q is real at both ends: the part that its argument lacks there to a multiple of pi belongs to the turn.
    const double start = std::arg(left.q), beyond = start - std::numbers::pi * std::round(start / std::numbers::pi);
    Winding winding(left.q);
    StabilityCount count;
    for (const Complex pole : loop.plant().poles()) count.unstable_poles += !(magnitude(pole) < kMaxPole);
    if (count.unstable_poles > 0) return count;
    if (loop.finite_at_zero()) {
        const Complex L = loop.open_loop(0);
        count.on_the_boundary = magnitude(1.0 + L) <= kMaxAxisDistance * (1 + magnitude(L));
    }
    for (std::size_t i = 1; i < along.omega.size() && !count.on_the_boundary; ++i) {
        const auto right = q.at(along.omega[i], along.point[i].L);
        // At a pole of the plant on the circle q is 0 times infinity: its neighbours decide.
        if (!(right.size < kMinModulusAtPole)) continue;
        count.on_the_boundary = !follow(q, winding, left, right);
        left = right;
    }
    count.unstable_poles = static_cast<int>(std::lround(-(beyond + winding.angle()) / std::numbers::pi));
    return count;
}

}  // namespace tunewright
