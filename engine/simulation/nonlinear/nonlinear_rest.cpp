#include "engine/simulation/nonlinear/nonlinear_rest.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/linear_algebra.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kMaxIterations = 40, kMaxHalvings = 20;
constexpr double kDone = 1e-12, kRounding = 1e-9;  // of a Newton step, relative to the values and to their sizes

/// The equations of rest in (x, u): f = 0 and what closes the loop.
struct Rest {
    const NonlinearLoop& loop;
    const StepInputs& in;
    std::optional<double> held;  // u at a limit; else the control law's
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
                done = done && std::abs((*step)[i]) <= std::max(kRounding * sizes[i], kDone * std::abs(next[i]));
            }
            v.swap(next);
            if (done) return true;
        }
        return false;
    }
};

}  // namespace

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
        const double slack = 1e-9 * std::abs(v.back());
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
