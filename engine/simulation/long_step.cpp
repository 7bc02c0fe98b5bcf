#include "engine/simulation/long_step.h"

#include <utility>

namespace tunewright {

using Index = std::size_t;

namespace {

using Cubic = std::array<double, 4>;

Cubic derivative(const Cubic& c) { return {c[1], c[2], c[3], 0}; }

void add_product(const std::vector<double>& F, const std::vector<double>& x, std::vector<double>& sum) {
    const Index n = x.size();
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) sum[i] += F[i * n + j] * x[j];
}

/// Of length (2^(level - level_of_L) - 1) L.
ExactStep beyond_L(Propagator& propagator, int level, int level_of_L) {
    const ExactStep over_L = propagator.level(level_of_L);
    ExactStep rest = over_L;  // (2^k - 1) L = 2 (2^(k-1) - 1) L + L
    for (int k = level_of_L + 2; k <= level; ++k) rest = propagator.compose(propagator.compose(rest, rest), over_L);
    return rest;
}

}  // namespace

LongStep::LongStep(const ResponseSystem& system, Propagator& propagator, int level, int level_of_L)
    : LongStep(system, propagator.level(level_of_L), beyond_L(propagator, level, level_of_L)) {}

LongStep::LongStep(const ResponseSystem& system, ExactStep over_L, ExactStep rest)
    : system_(&system), over_L_(std::move(over_L)), rest_(std::move(rest)), h_(over_L_.h + rest_.h) {
    effects_ = {effect({1, 0, 0}), effect({0, 1 / h_, 0}), effect({0, 0, 1 / (h_ * h_)})};
    invert();
}

void LongStep::start(Signal v0, Signal w0, const std::vector<double>& x, std::vector<double>& scratch,
                     Start& start) const {
    start.x = x;
    start.rate = system_->b;
    add_input(v0.value, start.rate);
    add_product(system_->F, x, start.rate);
    start.curvature.assign(x.size(), 0.0);
    add_input(v0.slope, start.curvature);
    add_product(system_->F, start.rate, start.curvature);
    const Cubic over_L = hermite_taylor(over_L_.h, v0.value, v0.slope, w0.value, w0.slope);
    advance(over_L_, over_L, start.x, scratch);
    advance_rate(over_L_, derivative(over_L), start.rate, scratch);
    advance_rate(over_L_, derivative(derivative(over_L)), start.curvature, scratch);
    add_input(-w0.slope, start.curvature);
    const Cubic known = cubic(w0.value, {});
    advance(rest_, known, start.x, scratch);
    to_end(known, start, scratch);
    start.v_end = delayed_end(known);
    start.w_end = output(start, known);
    start.w_end[0] += system_->s.R * system_->in.r + system_->in.d;
}

/// The derivatives over the rest of the step; v' jumps at its beginning to the cubic's.
void LongStep::to_end(const Cubic& c, Start& states, std::vector<double>& scratch) const {
    add_input(c[1], states.curvature);
    advance_rate(rest_, derivative(c), states.rate, scratch);
    advance_rate(rest_, derivative(derivative(c)), states.curvature, scratch);
}

void LongStep::add_input(double v, std::vector<double>& rate) const {
    for (Index i = 0; i < rate.size(); ++i) rate[i] += system_->G[i] * v;
}

Signal LongStep::finish(const Start& start, const Jet& added, std::vector<double>& x) const {
    // The unknowns are w, h w' and h^2 w'' at the end: known part + effects of the unknowns.
    const Jet known{start.w_end[0] + added[0], h_ * (start.w_end[1] + added[1]), h_ * h_ * (start.w_end[2] + added[2])};
    Signal v = start.v_end;
    x = start.x;
    for (Index k = 0; k < 3; ++k) {
        const double w =
            solution_[3 * k] * known[0] + solution_[3 * k + 1] * known[1] + solution_[3 * k + 2] * known[2];
        for (Index i = 0; i < x.size(); ++i) x[i] += effects_[k].x[i] * w;
        v.value += effects_[k].v.value * w;
        v.slope += effects_[k].v.slope * w;
    }
    return v;
}

LongStep::Cubic LongStep::cubic(double w0, const Jet& end) const {
    // w(s) = sum_{k < 3} end_k (s - h)^k/k! + a (s - h)^3, with w(0) = w0.
    const double h = h_, a = (end[0] - h * end[1] + h * h * end[2] / 2 - w0) / (h * h * h);
    return {w0, end[1] - h * end[2] + 3 * a * h * h, end[2] - 6 * a * h, 6 * a};
}

Signal LongStep::delayed_end(const Cubic& c) const {
    const double s = rest_.h;
    return {c[0] + s * (c[1] + s * (c[2] / 2 + s * c[3] / 6)), c[1] + s * (c[2] + s * c[3] / 2)};
}

/// w, w' and w'' at the end, without the constant inputs.
LongStep::Jet LongStep::output(const Start& at_end, const Cubic& c) const {
    const DelaySystem& s = system_->s;
    const Signal v = delayed_end(c);
    Jet w{s.N * v.value, s.N * v.slope, s.N * (c[2] + rest_.h * c[3])};
    for (Index i = 0; i < Index(s.n); ++i) {
        w[0] += s.M[i] * at_end.x[i];
        w[1] += s.M[i] * at_end.rate[i];
        w[2] += s.M[i] * at_end.curvature[i];
    }
    return w;
}

LongStep::Effect LongStep::effect(const Jet& end) const {
    const Cubic c = cubic(0, end);
    const Index n = Index(system_->n);
    Start states;
    std::vector<double> scratch(n);
    for (auto* vector : {&states.x, &states.rate, &states.curvature}) vector->assign(n, 0.0);
    advance_rate(rest_, c, states.x, scratch);
    to_end(c, states, scratch);
    Effect e{states.x, delayed_end(c), output(states, c)};
    e.out[1] *= h_;
    e.out[2] *= h_ * h_;
    return e;
}

void LongStep::invert() {
    std::array<double, 9> m{};
    for (Index row = 0; row < 3; ++row)
        for (Index k = 0; k < 3; ++k) m[3 * row + k] = (row == k ? 1.0 : 0.0) - effects_[k].out[row];
    const auto cofactor = [&](Index i, Index j) {
        const Index a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        return m[3 * a + c] * m[3 * b + d] - m[3 * a + d] * m[3 * b + c];
    };
    const double determinant = m[0] * cofactor(0, 0) + m[1] * cofactor(0, 1) + m[2] * cofactor(0, 2);
    for (Index i = 0; i < 3; ++i)
        for (Index j = 0; j < 3; ++j) solution_[3 * i + j] = cofactor(j, i) / determinant;
}

}  // namespace tunewright
