#include "engine/simulation/linear/long_step.h"

#include <Eigen/LU>
#include <algorithm>
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
    row.resize(Index(system_->n), 0.0);  // the error's integral does not affect the output
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

/// The contribution of the inputs to the output at the end, without that of the states; `constant`: factor of the
/// constant inputs.
LongStep::Jet LongStep::end_of(const Cubic& over_L, const Cubic& known, Signal v0, Signal w0, double constant) const {
    Jet end = through_cubic(known);
    // x' = F x + G v0 + b at the start, then x'' = F x' + G v'; v' jumps to the cubic's where the rest begins.
    const auto& m = over_L_moments_;
    end[0] = system_->s.N * delayed_end(known).value + constant * (system_->s.R * system_->in.r + system_->in.d);
    end[1] += whole_G_ * v0.value + constant * whole_b_ + m[0] * over_L[1] + m[1] * over_L[2] + m[2] * over_L[3];
    end[2] += slope_G_ * v0.value + constant * slope_b_ + whole_G_ * v0.slope + m[0] * over_L[2] + m[1] * over_L[3] -
              rest_G_ * w0.slope;
    return end;
}

void LongStep::start(Signal v0, Signal w0, const std::vector<double>& x, Start& start) const {
    const Cubic over_L = hermite_taylor(over_L_.h, v0, w0);
    const Cubic known = cubic(w0.value, {});
    start.v_end = delayed_end(known);
    start.w_end = end_of(over_L, known, v0, w0, 1);
    start.w_end[1] += dot(to_slope_, x);
    start.w_end[2] += dot(to_curvature_, x);
    start.x = x;
    advance(over_L_, over_L, start.x);
    advance(rest_, known, start.x);
    // The value follows from the states themselves: they contain the input over the rest.
    start.w_end[0] += output_of(start.x.data());
}

double LongStep::output_of(const double* x) const {
    double w = 0;
    for (Index i = 0; i < Index(system_->s.n); ++i) w += system_->s.M[i] * x[i];
    return w;
}

/// The unknowns are w, h w' and h^2 w'' at the end: known part + effects of the unknowns.
LongStep::Jet LongStep::solved(const Jet& known) const {
    Jet w{};
    for (Index k = 0; k < 3; ++k)
        w[k] = solution_[3 * k] * known[0] + solution_[3 * k + 1] * (h_ * known[1]) +
               solution_[3 * k + 2] * (h_ * h_ * known[2]);
    return w;
}

/// Adds the effects of the output at the end (w, h w' and h^2 w'') to the states and to the delayed signal there.
Signal LongStep::with_effects(const Jet& w, Signal v, double* x) const {
    for (Index k = 0; k < 3; ++k) {
        for (Index i = 0; i < rest_.n; ++i) x[i] += effects_[k].x[i] * w[k];
        v.value += effects_[k].v.value * w[k];
        v.slope += effects_[k].v.slope * w[k];
    }
    return v;
}

Signal LongStep::finish(const Start& start, const Jet& added, std::vector<double>& x) const {
    const Jet w = solved({start.w_end[0] + added[0], start.w_end[1] + added[1], start.w_end[2] + added[2]});
    x = start.x;
    return with_effects(w, start.v_end, x.data());
}

StepMap LongStep::map() const {
    const Index n = rest_.n, length = rest_.length();
    // The columns over the dead time, propagated over the rest: by the states, by the cubic's coefficients and by 1.
    std::vector<double> carried(over_L_.columns.size());
    multiply_columns(carried_over(rest_, over_L_, carried.data()));
    StepMap map(*system_, h_);
    std::vector<Signal> v(n + kStepInputs);
    const auto solve = [&](Index k, Jet end, Signal delayed) {
        double* x = map.column(k);
        end[0] += output_of(x);
        v[k] = with_effects(solved(end), delayed, x);
    };
    for (Index k = 0; k < n; ++k) {
        std::copy_n(carried.data() + k * length, n, map.column(k));
        solve(k, {0, to_slope_[k], to_curvature_[k]}, {});
    }
    const auto from_input = [&](Index k, Signal v0, Signal w0, double constant) {
        const Cubic over_L = hermite_taylor(over_L_.h, v0, w0), known = cubic(w0.value, {});
        const double *moments = carried.data() + n * length, *of_rest = rest_.columns.data() + n * length;
        double* x = map.column(n + k);
        for (Index j = 0; j < 4; ++j)
            for (Index i = 0; i < n; ++i)
                x[i] += moments[j * length + i] * over_L[j] + of_rest[j * length + i] * known[j];
        for (Index i = 0; i < n; ++i) x[i] += constant * (moments[4 * length + i] + of_rest[4 * length + i]);
        solve(n + k, end_of(over_L, known, v0, w0, constant), delayed_end(known));
    };
    from_input(0, {}, {}, 1);
    from_input(1, {1, 0}, {}, 0);
    from_input(2, {0, 1}, {}, 0);
    from_input(3, {}, {1, 0}, 0);
    from_input(4, {}, {0, 1}, 0);
    map.add_outputs(*system_);
    for (Index k = 0; k < v.size(); ++k) map.feed_through(*system_, k, v[k]);
    return map;
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

/// Contribution of the delayed signal over the rest of the step to w, w' and w'' at the end.
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

const LongStep& LongSteps::level(int level, Propagator& propagator) {
    if (steps_.empty()) {
        const ExactStep& over_L = propagator.level(level_of_L_);
        steps_.emplace_back(*system_, over_L, over_L);
    }
    while (static_cast<int>(steps_.size()) < level - level_of_L_) steps_.emplace_back(propagator, steps_.back());
    return steps_[Index(level - level_of_L_ - 1)];
}

}  // namespace tunewright
