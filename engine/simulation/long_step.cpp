#include "engine/simulation/long_step.h"

namespace tunewright {

using Index = std::size_t;

LongStep::LongStep(const ResponseSystem& system, Propagator& propagator, int level, int level_of_L)
    : system_(system), propagator_(propagator) {
    over_L_ = propagator.level(level_of_L);
    rest_ = over_L_;  // (2^k - 1) L = 2 (2^(k-1) - 1) L + L
    for (int k = level_of_L + 2; k <= level; ++k) rest_ = propagator.compose(propagator.compose(rest_, rest_), over_L_);
    h_ = over_L_.h + rest_.h;
    end_value_ = effect({0, 0, 1, 0});
    end_slope_ = effect({0, 0, 0, 1});
}

void LongStep::start(Signal v0, Signal w0, const std::vector<double>& x, std::vector<double>& scratch,
                     Start& start) const {
    start.x = x;
    propagator_.advance(over_L_, hermite_taylor(over_L_.h, v0.value, v0.slope, w0.value, w0.slope), start.x, scratch);
    const std::array<double, 4> known = {w0.value, w0.slope, 0, 0};
    propagator_.advance(rest_, taylor(known), start.x, scratch);
    start.v_end = at_end(known);
    start.w_end = output(start.x, start.v_end, true);
}

Signal LongStep::finish(const Start& start, Signal added, std::vector<double>& x) const {
    // Solve (w1, w1') = known part + effects.
    const double base = start.w_end.value + added.value, base_slope = start.w_end.slope + added.slope;
    const double a = 1 - end_value_.out.value, b = -end_slope_.out.value, c = -end_value_.out.slope,
                 d = 1 - end_slope_.out.slope;
    const double determinant = a * d - b * c;
    const double w1 = (d * base - b * base_slope) / determinant, dw1 = (a * base_slope - c * base) / determinant;
    for (Index i = 0; i < x.size(); ++i) x[i] = start.x[i] + end_value_.x[i] * w1 + end_slope_.x[i] * dw1;
    return {start.v_end.value + end_value_.v.value * w1 + end_slope_.v.value * dw1,
            start.v_end.slope + end_value_.v.slope * w1 + end_slope_.v.slope * dw1};
}

Signal LongStep::at_end(const std::array<double, 4>& ends) const {
    const auto c = taylor(ends);
    const double s = rest_.h;
    return {c[0] + s * (c[1] + s * (c[2] / 2 + s * c[3] / 6)), c[1] + s * (c[2] + s * c[3] / 2)};
}

/// w and its slope from states and delayed signal; the constant inputs only where asked.
Signal LongStep::output(const std::vector<double>& x, Signal v, bool with_inputs) const {
    const DelaySystem& s = system_.s;
    Signal w{s.N * v.value, system_.MG * v.value + s.N * v.slope};
    if (with_inputs) w = {w.value + s.R * system_.in.r + system_.in.d, w.slope + system_.MH};
    for (int i = 0; i < s.n; ++i) {
        w.value += s.M[Index(i)] * x[Index(i)];
        w.slope += system_.MF[Index(i)] * x[Index(i)];
    }
    return w;
}

LongStep::Effect LongStep::effect(const std::array<double, 4>& ends) const {
    Effect e;
    const auto c = taylor(ends);
    e.x.assign(Index(system_.n), 0);
    for (int j = 0; j < 4; ++j)
        for (Index i = 0; i < e.x.size(); ++i) e.x[i] += rest_.Gamma[Index(j)][i] * c[Index(j)];
    e.v = at_end(ends);
    e.out = output(e.x, e.v, false);
    return e;
}

}  // namespace tunewright
