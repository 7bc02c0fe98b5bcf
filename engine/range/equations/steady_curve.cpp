#include "engine/range/equations/steady_curve.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright::range {
namespace {

constexpr int kMaxNewton = 12;
constexpr double kConverged = 1e-11;  // relative to the unknowns' sizes: Newton's last step
constexpr double kMinSize = 1e-3;     // relative to the largest size that an unknown has had

}  // namespace

SteadyCurve::SteadyCurve(const NonlinearSystem& system, const EquationsRange& range, const SteadyState& start)
    : system_(system),
      along_(range.along),
      parameter_(range.along == Along::parameter),
      hold_output_(range.hold_output),
      n_(std::size_t(system.order()) - (parameter_ ? 1 : 0)),
      y_held_(start.y),
      u_held_(start.u) {}

void SteadyCurve::split(std::span<const double> z, std::vector<double>& x, double& u) const {
    x.assign(z.begin(), z.begin() + std::ptrdiff_t(n_));
    if (parameter_) x.push_back(z[n_ + 1]);
    u = z[n_];
}

double SteadyCurve::place(std::span<const double> z) const {
    if (along_ == Along::input) return z[n_];
    if (along_ == Along::parameter) return z[n_ + 1];
    std::vector<double> x;
    double u = 0;
    split(z, x, u);
    return system_.output(x);
}

std::vector<double> SteadyCurve::place_gradient(std::span<const double> z) const {
    std::vector<double> gradient(unknowns(), 0.0);
    if (along_ == Along::input) gradient[n_] = 1;
    if (along_ == Along::parameter) gradient[n_ + 1] = 1;
    if (along_ != Along::output) return gradient;
    std::vector<double> x;
    double u = 0;
    split(z, x, u);
    std::vector<double> C(x.size());
    if (!system_.output_gradient(x, C)) return {};
    std::copy_n(C.begin(), n_, gradient.begin());
    return gradient;
}

bool SteadyCurve::equations(std::span<const double> z, std::vector<double>& F, std::vector<double>& J) const {
    const std::size_t m = unknowns(), order = std::size_t(system_.order());
    std::vector<double> x;
    double u = 0;
    split(z, x, u);
    std::vector<double> dx(order), A(order * order), B(order), C(order);
    if (!system_.rates(x, u, dx) || !system_.jacobian(x, u, A, B)) return false;
    F.assign(m - 1, 0.0);
    J.assign((m - 1) * m, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
        F[i] = dx[i];
        std::copy_n(&A[i * order], n_, &J[i * m]);
        J[i * m + n_] = B[i];
        if (parameter_) J[i * m + n_ + 1] = A[i * order + n_];
    }
    if (!parameter_) return true;
    if (!hold_output_) {
        F[n_] = u - u_held_;
        J[n_ * m + n_] = 1;
        return true;
    }
    F[n_] = system_.output(x) - y_held_;
    if (!std::isfinite(F[n_]) || !system_.output_gradient(x, C)) return false;
    std::copy_n(C.begin(), n_, &J[n_ * m]);
    J[n_ * m + n_ + 1] = C[n_];
    return true;
}

namespace {

/// Divides the rows by their largest entry, once the columns are in sizes of the unknowns: (m - 1) x m, and F with
/// them.
bool scale(std::vector<double>& J, std::vector<double>& F, std::span<const double> sizes) {
    const std::size_t m = sizes.size();
    for (std::size_t i = 0; i < F.size(); ++i) {
        double largest = 0;
        for (std::size_t j = 0; j < m; ++j) largest = std::max(largest, std::abs(J[i * m + j] *= sizes[j]));
        if (!(largest > 0)) return false;
        for (std::size_t j = 0; j < m; ++j) J[i * m + j] /= largest;
        F[i] /= largest;
    }
    return true;
}

double length(std::span<const double> v) { return std::sqrt(dot(v, v)); }

}  // namespace

std::optional<std::vector<double>> SteadyCurve::tangent(std::span<const double> z, std::span<const double> sizes,
                                                        std::span<const double> before) const {
    std::vector<double> F, J;
    if (!equations(z, F, J) || !scale(J, F, sizes)) return std::nullopt;
    J.insert(J.end(), before.begin(), before.end());
    std::vector<double> right(unknowns(), 0.0);
    right.back() = 1;
    auto t = solve(J, right, int(unknowns()));
    if (!t) return std::nullopt;
    const double size = length(*t);
    if (!std::isfinite(size) || !(size > 0)) return std::nullopt;
    for (double& component : *t) component /= size;
    return t;
}

std::optional<int> SteadyCurve::correct_across(std::vector<double>& z, std::span<const double> sizes,
                                               std::span<const double> row, std::span<const double> target) const {
    const std::size_t m = unknowns();
    for (int k = 1; k <= kMaxNewton; ++k) {
        std::vector<double> F, J;
        if (!equations(z, F, J) || !scale(J, F, sizes)) return std::nullopt;
        J.insert(J.end(), row.begin(), row.end());
        double off = 0;
        for (std::size_t i = 0; i < m; ++i) off += row[i] * (z[i] - target[i]) / sizes[i];
        F.push_back(off);
        for (double& f : F) f = -f;
        const auto step = solve(J, F, int(m));
        if (!step) return std::nullopt;
        for (std::size_t i = 0; i < m; ++i) z[i] += (*step)[i] * sizes[i];
        const double moved = length(*step);
        if (!std::isfinite(moved)) return std::nullopt;
        if (moved < kConverged) return k;
    }
    return std::nullopt;
}

bool SteadyCurve::correct_to_place(std::vector<double>& z, std::span<const double> sizes, double at) const {
    const std::size_t m = unknowns();
    for (int k = 0; k < kMaxNewton; ++k) {
        std::vector<double> F, J;
        const auto row = place_gradient(z);
        if (row.empty() || !equations(z, F, J)) return false;
        J.insert(J.end(), row.begin(), row.end());
        F.push_back(place(z) - at);
        if (!scale(J, F, sizes)) return false;
        for (double& f : F) f = -f;
        const auto step = solve(J, F, int(m));
        if (!step) return false;
        for (std::size_t i = 0; i < m; ++i) z[i] += (*step)[i] * sizes[i];
        const double moved = length(*step);
        if (!std::isfinite(moved)) return false;
        if (moved < kConverged) return true;
    }
    return false;
}

std::vector<double> SteadyCurve::sizes(std::span<const double> z, std::vector<double>& largest) const {
    largest.resize(unknowns(), 0.0);
    std::vector<double> result;
    for (std::size_t i = 0; i < unknowns(); ++i) {
        largest[i] = std::max(largest[i], std::abs(z[i]));
        result.push_back(std::max(std::abs(z[i]), kMinSize * largest[i]));
    }
    for (double& size : result)
        if (!(size > 0)) size = 1;
    return result;
}

SteadyState SteadyCurve::state(std::span<const double> z) const {
    std::vector<double> x;
    SteadyState state;
    split(z, x, state.u);
    state.at = place(z);
    state.y = system_.output(x);
    state.p = parameter_ ? z[n_ + 1] : 0;
    state.x.assign(z.begin(), z.begin() + std::ptrdiff_t(n_));
    return state;
}

std::vector<double> SteadyCurve::z(const SteadyState& state) const {
    std::vector<double> z = state.x;
    z.push_back(state.u);
    if (parameter_) z.push_back(state.p);
    return z;
}

}  // namespace tunewright::range
