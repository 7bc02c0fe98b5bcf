#include "engine/simulation/linear/long_step.h"

#include <Eigen/LU>
#include <utility>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {

using Index = std::size_t;

// 2 (L + rest) = L + (2 rest + L).
LongStep::LongStep(const Propagator& propagator, const LongStep& half)
    : LongStep(*half.system_, half.over_L_,
               propagator.compose(propagator.compose(half.rest_, half.rest_), half.over_L_)) {}

LongStep::LongStep(const ResponseSystem& system, ExactStep over_L, ExactStep rest)
    : system_(&system), over_L_(std::move(over_L)), rest_(std::move(rest)), h_(over_L_.h + rest_.h) {
    work_out_rows();
    effects_ = {effect({1, 0, 0}), effect({0, 1 / h_, 0}), effect({0, 0, 1 / (h_ * h_)})};
    invert();
}

void LongStep::work_out_rows() {
    std::vector<double> row = system_->s.M;
    row.resize(Index(system_->n), 0.0);  // the error's integral is no part of the output
    for (Index j = 0; j < 4; ++j) rest_moments_[j] = dot(row, rest_.Gamma(j));
    row = carried_over(rest_, row);
    rest_G_ = dot(row, system_->G);
    for (Index j = 0; j < 4; ++j) over_L_moments_[j] = dot(row, over_L_.Gamma(j));
    row = carried_over(over_L_, row);
    whole_G_ = dot(row, system_->G);
    whole_b_ = dot(row, system_->b);
    to_slope_ = row_times(row, system_->F);
    slope_G_ = dot(to_slope_, system_->G);
    slope_b_ = dot(to_slope_, system_->b);
    to_curvature_ = row_times(to_slope_, system_->F);
}

void LongStep::start(Signal v0, Signal w0, const std::vector<double>& x, Start& start) const {
    const Cubic over_L = hermite_taylor(over_L_.h, v0, w0);
    const Cubic known = cubic(w0.value, {});
    start.v_end = delayed_end(known);
    start.w_end = through_cubic(known);
    // x' = F x + G v0 + b at the start, then x'' = F x' + G v'; v' jumps to the cubic's where the rest begins.
    const auto& m = over_L_moments_;
    start.w_end[1] +=
        dot(to_slope_, x) + whole_G_ * v0.value + whole_b_ + m[0] * over_L[1] + m[1] * over_L[2] + m[2] * over_L[3];
    start.w_end[2] += dot(to_curvature_, x) + slope_G_ * v0.value + slope_b_ + whole_G_ * v0.slope + m[0] * over_L[2] +
                      m[1] * over_L[3] - rest_G_ * w0.slope;
    start.x = x;
    advance(over_L_, over_L, start.x);
    advance(rest_, known, start.x);
    // The value from the states themselves: the input over the rest is in them.
    const DelaySystem& s = system_->s;
    start.w_end[0] = s.N * start.v_end.value + s.R * system_->in.r + system_->in.d;
    for (Index i = 0; i < Index(s.n); ++i) start.w_end[0] += s.M[i] * start.x[i];
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

Cubic LongStep::cubic(double w0, const Jet& end) const {
    // w(s) = sum_{k < 3} end_k (s - h)^k/k! + a (s - h)^3, with w(0) = w0.
    const double h = h_, a = (end[0] - h * end[1] + h * h * end[2] / 2 - w0) / (h * h * h);
    return {w0, end[1] - h * end[2] + 3 * a * h * h, end[2] - 6 * a * h, 6 * a};
}

Signal LongStep::delayed_end(const Cubic& c) const {
    const double s = rest_.h;
    return {value_at(c, s), slope_at(c, s)};
}

/// What w, w' and w'' at the end get from the delayed signal over the rest of the step.
LongStep::Jet LongStep::through_cubic(const Cubic& c) const {
    const auto& m = rest_moments_;
    const Signal v = delayed_end(c);
    const double N = system_->s.N;
    return {N * v.value + m[0] * c[0] + m[1] * c[1] + m[2] * c[2] + m[3] * c[3],
            N * v.slope + m[0] * c[1] + m[1] * c[2] + m[2] * c[3],
            N * (c[2] + rest_.h * c[3]) + m[0] * c[2] + m[1] * c[3] + rest_G_ * c[1]};
}

LongStep::Effect LongStep::effect(const Jet& end) const {
    const Cubic c = cubic(0, end);
    Effect e{std::vector<double>(Index(system_->n), 0.0), delayed_end(c), through_cubic(c)};
    for (Index j = 0; j < 4; ++j)
        for (Index i = 0; i < e.x.size(); ++i) e.x[i] += rest_.Gamma(j)[i] * c[j];
    e.out[1] *= h_;
    e.out[2] *= h_ * h_;
    return e;
}

void LongStep::invert() {
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    for (Eigen::Index row = 0; row < 3; ++row)
        for (Eigen::Index k = 0; k < 3; ++k) m(row, k) -= effects_[Index(k)].out[Index(row)];
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(solution_.data()) = m.inverse();
}

}  // namespace tunewright
