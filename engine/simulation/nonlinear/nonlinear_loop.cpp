#include "engine/simulation/nonlinear/nonlinear_loop.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/matrix/resolvent.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/run/delayed_input.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kEchoes = 6;  // echoes of a jump: the plant smooths it at each passage, finally beyond the order of the
                            // method
constexpr int kMaxSecants = 30;
constexpr double kSecantDone = 1e-14;

constexpr int kMaxIterations = 40, kMaxHalvings = 20;
constexpr double kRestLimitTolerance =
    1e-9;  // of u at rest: rounding of Newton's method; closer to a limit u counts as being at it
constexpr double kNewtonTolerance = 1e-12,
                 kNewtonRounding = 1e-9;  // of a Newton step, relative to the values and to their sizes

/// The equations of rest in (x, u): f = 0 and the equation that closes the loop.
struct Rest {
    const NonlinearLoop& loop;
    const StepInputs& in;
    std::optional<double> held;  // u, if it is at a limit; else the control law applies
    Index n;
    std::vector<double> A, B, C;

    Rest(const NonlinearLoop& l, const StepInputs& inputs, std::optional<double> u)
        : loop(l), in(inputs), held(u), n(Index(l.system().order())), A(n * n), B(n), C(n) {}

    bool residual(const std::vector<double>& v, std::vector<double>& out) const {
        const NonlinearSystem& system = loop.system();
        const std::span<const double> x(v.data(), n);
        if (!system.rates(x, system.u_nominal() + v[n] + in.d, {out.data(), n})) return false;
        const double y = system.output(x) - system.y_steady();
        out[n] = held ? v[n] - *held : loop.law().integrates() ? y - in.r : v[n] - loop.law().command_at_rest(y);
        return std::isfinite(out[n]);
    }

    bool matrix(const std::vector<double>& v, std::vector<double>& M) {
        const NonlinearSystem& system = loop.system();
        const std::span<const double> x(v.data(), n);
        if (!system.jacobian(x, system.u_nominal() + v[n] + in.d, A, B) || !system.output_gradient(x, C)) return false;
        const bool by_error = !held && loop.law().integrates();
        for (Index i = 0; i < n; ++i) {
            for (Index j = 0; j < n; ++j) M[i * (n + 1) + j] = A[i * n + j];
            M[i * (n + 1) + n] = B[i];
            M[n * (n + 1) + i] = held ? 0 : by_error ? C[i] : -loop.law().command_at_rest_by_y() * C[i];
        }
        M[n * (n + 1) + n] = by_error ? 0 : 1;
        return true;
    }

    /// Newton's method; a step that leaves the domain is halved.
    bool solve_from(std::vector<double>& v, const std::vector<double>& sizes) {
        std::vector<double> r(n + 1), M((n + 1) * (n + 1)), next(n + 1);
        if (!residual(v, r)) return false;
        for (int k = 0; k < kMaxIterations; ++k) {
            if (!matrix(v, M)) return false;
            const auto step = solve(M, r, int(n + 1));
            if (!step) return false;
            double length = 1;
            for (int halving = 0;; ++halving) {
                for (Index i = 0; i <= n; ++i) next[i] = v[i] - length * (*step)[i];
                if (residual(next, r)) break;
                if (halving == kMaxHalvings) return false;
                length *= 0.5;
            }
            bool done = length == 1;
            for (Index i = 0; i <= n; ++i) {
                if (!std::isfinite(next[i])) return false;
                done = done && std::abs((*step)[i]) <=
                                   std::max(kNewtonRounding * sizes[i], kNewtonTolerance * std::abs(next[i]));
            }
            v.swap(next);
            if (done) return true;
        }
        return false;
    }
};

}  // namespace

ActuatorLimits input_limits(const NonlinearSystem& system, const std::optional<ActuatorLimits>& actuator) {
    ActuatorLimits limits{system.u_min() - system.u_nominal(), system.u_max() - system.u_nominal()};
    if (actuator) {
        limits.min = std::max(limits.min, actuator->min);
        limits.max = std::min(limits.max, actuator->max);
    }
    return limits;
}

double back_calculation_rate(const NonlinearSystem& system, const ParallelPid& controller,
                             const ActuatorLimits& limits) {
    if (controller.Ki == 0 || (std::isinf(limits.min) && std::isinf(limits.max))) return 0;
    auto time = tracking_time(controller);
    if (!time)
        if (const auto plant = LinearPlant::make(system.linearised())) time = tracking_time(*plant, controller);
    return time && *time > 0 ? 1 / *time : 0;
}

double size_of_effect(const NonlinearSystem& system, double d) {
    if (d == 0) return 0;
    const StateSpace& plant = system.linearised();
    const int n = system.order();
    const std::vector<double> A = row_by_row(plant.A);
    double time = plant.L;
    for (const auto pole : eigenvalues(A, n))
        if (std::abs(pole) > 0) time += 1 / std::abs(pole);
    const double omega = time > 0 ? 1 / time : 1;
    const double effect = std::abs(d * resolvent_response(A, plant.B, plant.C, 0, n, {0, omega}));
    return std::isfinite(effect) ? effect : 0;
}

int passages_that_count(const NonlinearSystem& system, const ParallelPid& controller, double tolerance) {
    if (controller.Kd == 0 || controller.filter.type != FilterType::none) return kEchoes;
    const double q = dot(system.linearised().C, system.linearised().B);
    return echoes_that_count(std::abs(controller.Kd * q), tolerance, kEchoes);
}

NonlinearLoop::NonlinearLoop(const NonlinearSystem& system, const PidLaw& law, const StepInputs& inputs,
                             const ActuatorLimits& limits)
    : system_(system), law_(law), in_(inputs), limits_(limits), n_(Index(system.order())) {
    slope_.resize(n_);
    C_.resize(n_);
    B_.resize(n_);
    A_.resize(n_ * n_);
}

double NonlinearLoop::y_of(std::span<const double> z) const {
    return system_.output(plant_states(z)) - system_.y_steady();
}

bool NonlinearLoop::y_slope(std::span<const double> x, double w, double& slope) const {
    if (!system_.rates(x, system_.u_nominal() + w, slope_)) return false;
    slope = dot(C_, slope_);
    return true;
}

// Without dead time the command depends on y', y' on u, and u on the command: solved by secants, in one step if f is
// affine in u.
NonlinearLoop::Output NonlinearLoop::output_of_pure_derivative(Region region, std::span<const double> z,
                                                               double w_then) const {
    Output out;
    const auto x = plant_states(z), s = law_states(z);
    out.y = y_of(z);
    double slope = 0;
    if (!system_.output_gradient(x, C_)) return {0, 0, 0, false};
    if (delayed() || region != Region::inside) {
        out.exists = y_slope(x, delayed() ? w_then : limit(region) + in_.d, slope);
        out.command = law_.command(out.y, slope, s);
        out.u = region == Region::inside ? out.command : limit(region);
        return out;
    }
    double u_before = law_.command(out.y, 0, s);
    if (!y_slope(x, u_before + in_.d, slope)) return {0, 0, 0, false};
    double u = law_.command(out.y, slope, s), gap_before = u - u_before;
    for (int i = 0; i < kMaxSecants && gap_before != 0; ++i) {
        if (!y_slope(x, u + in_.d, slope)) return {0, 0, 0, false};
        const double gap = law_.command(out.y, slope, s) - u;
        if (std::abs(gap) <= kSecantDone * (std::abs(u) + std::abs(slope)) || gap == gap_before) break;
        const double next = u - gap * (u - u_before) / (gap - gap_before);
        u_before = u;
        gap_before = gap;
        u = next;
    }
    out.command = out.u = u;
    out.exists = std::isfinite(u);
    return out;
}

NonlinearLoop::Output NonlinearLoop::output(Region region, std::span<const double> z, double w_then) const {
    if (law_.pure_derivative()) return output_of_pure_derivative(region, z, w_then);
    Output out;
    out.y = y_of(z);
    out.command = law_.command(out.y, 0, law_states(z));
    out.u = region == Region::inside ? out.command : limit(region);
    out.exists = std::isfinite(out.command);
    return out;
}

Region NonlinearLoop::region(std::span<const double> z, double w_then) const {
    const Output inside = output(Region::inside, z, w_then);
    if (inside.command > limits_.max) return Region::above;
    if (inside.command < limits_.min) return Region::below;
    return Region::inside;
}

bool NonlinearLoop::rates(Region region, std::span<const double> z, double w_then, std::span<double> dz) const {
    const Output out = output(region, z, w_then);
    if (!out.exists) return false;
    const double w = delayed() ? w_then : out.u + in_.d;
    if (!system_.rates(plant_states(z), system_.u_nominal() + w, dz.first(n_))) return false;
    law_.rates(out.y, law_states(z), out.u - out.command, dz.subspan(n_));
    return true;
}

bool NonlinearLoop::jacobian(Region region, std::span<const double> z, double w_then, double w_then_slope,
                             std::span<double> J, std::span<double> ft) const {
    const Output out = output(region, z, w_then);
    const double w = delayed() ? w_then : out.u + in_.d;
    const auto x = plant_states(z);
    if (!out.exists || !system_.output_gradient(x, C_) || !system_.jacobian(x, system_.u_nominal() + w, A_, B_))
        return false;
    const Index m = Index(law_.order()), wide = n_ + m;
    const bool fed_back = !delayed() && region == Region::inside;
    const double tracking = region == Region::inside ? 0 : law_.tracking_rate();
    for (Index i = 0; i < n_; ++i) {
        const double by_u = fed_back ? B_[i] : 0;
        for (Index j = 0; j < n_; ++j) J[i * wide + j] = A_[i * n_ + j] + by_u * law_.command_by_y() * C_[j];
        for (Index j = 0; j < m; ++j) J[i * wide + n_ + j] = by_u * law_.command_by_state(int(j));
        ft[i] = delayed() ? B_[i] * w_then_slope : 0;
    }
    for (Index i = 0; i < m; ++i) {
        const double by_y = law_.rate_by_y(int(i), out.y) - (i == 0 ? tracking * law_.command_by_y() : 0);
        for (Index j = 0; j < n_; ++j) J[(n_ + i) * wide + j] = by_y * C_[j];
        for (Index j = 0; j < m; ++j)
            J[(n_ + i) * wide + n_ + j] =
                law_.rate_by_state(int(i), int(j)) - (i == 0 ? tracking * law_.command_by_state(int(j)) : 0);
        ft[n_ + i] = 0;
    }
    return true;
}

std::optional<NonlinearRest> find_rest(const NonlinearLoop& loop, const StepInputs& inputs, std::vector<double> x,
                                       double u, const std::vector<double>& sizes) {
    std::vector<double> v = std::move(x);
    v.push_back(u);
    const std::vector<double> start = v;
    const auto answer = [&](bool within) {
        NonlinearRest rest{within, 0, v.back(), {v.begin(), v.end() - 1}};
        rest.y = loop.system().output(rest.x) - loop.system().y_steady();
        return rest;
    };
    const ActuatorLimits& limits = loop.limits();
    double limit = u >= limits.max ? limits.max : limits.min;
    if (Rest(loop, inputs, std::nullopt).solve_from(v, sizes)) {
        const double slack = kRestLimitTolerance * std::abs(v.back());
        if (v.back() <= limits.max + slack && v.back() >= limits.min - slack) return answer(true);
        limit = v.back() > limits.max ? limits.max : limits.min;
    } else if (u < limits.max && u > limits.min) {
        return std::nullopt;
    }
    v = start;
    v.back() = limit;
    if (std::isfinite(limit) && Rest(loop, inputs, limit).solve_from(v, sizes)) return answer(false);
    return std::nullopt;
}

}  // namespace tunewright
