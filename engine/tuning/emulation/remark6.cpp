#include "engine/tuning/emulation/remark6.h"

#include <algorithm>
#include <cmath>

#include "engine/tuning/emulation/error_signals.h"
#include "engine/tuning/robust/quadratic_program.h"

namespace tunewright::emulation {
namespace {

constexpr double kOnLimit = 1e-9;  // relative
constexpr double kRidge = 1e-13;   // of the scaled normal matrix
constexpr int kLimitRounds = 30;   // until the samples beyond a limit stay the same
constexpr int kFilterScan = 9;     // points of a free filter
constexpr int kFilterSteps = 40;   // of the golden section between them
constexpr double kGolden = 0.6180339887498949;

using Gains = std::array<double, 3>;

Gains gains_at(const SettingsPoint& point) {
    return {point[0], point[0] / point[1], point.size() > 2 ? point[0] * point[2] : 0};
}

// The bounds on Kp, Ti, Td as half-planes of sign (Kp, Kp/Ti, Kp Td), Kp > 0 there; unknowns scaled.
std::vector<robust::LinearConstraint> half_planes(double sign, const Bounds& bounds, const Gains& scale,
                                                  bool derivative) {
    const double low = std::max(0.0, sign > 0 ? bounds.low[0] : -bounds.high[0]);
    const double high = sign > 0 ? bounds.high[0] : -bounds.low[0];
    std::vector<robust::LinearConstraint> planes = {{{scale[0], 0, 0}, high},
                                                    {{-scale[0], 0, 0}, -low},
                                                    {{-scale[0], bounds.low[1] * scale[1], 0}, 0},
                                                    {{scale[0], -bounds.high[1] * scale[1], 0}, 0}};
    if (derivative) {
        planes.push_back({{bounds.low[2] * scale[0], 0, -scale[2]}, 0});
        planes.push_back({{-bounds.high[2] * scale[0], 0, scale[2]}, 0});
    }
    return planes;
}

}  // namespace

Remark6::Remark6(const EmulationProblem& problem, const std::vector<Trajectory>& trajectories)
    : problem_(problem), trajectories_(trajectories) {
    const std::vector<double> simpson = simpson_weights(problem);
    for (std::size_t s = 0; s < trajectories.size(); ++s) {
        const NonlinearSystem& system = *problem.scenarios[s].system;
        const double low = system.u_min() - system.u_nominal(), high = system.u_max() - system.u_nominal();
        const double near = kOnLimit * (std::abs(system.u_nominal()) + std::sqrt(trajectories[s].u_size));
        for (std::size_t i = 0; i < simpson.size(); ++i) {
            const double u = trajectories[s].u_nl[i];
            weights_.push_back(problem.wu * simpson[i] / static_cast<double>(trajectories.size()));
            u_nl_.push_back(u);
            at_limit_.push_back(u >= high - near ? 1 : u <= low + near ? -1 : 0);
        }
    }
    fixed_ = signals(problem.Tf);
}

Remark6::Signals Remark6::signals(double Tf) const {
    Signals all;
    const double h = problem_.horizon / problem_.intervals;
    for (std::size_t s = 0; s < trajectories_.size(); ++s) {
        const double r = problem_.scenarios[s].setpoint_step;
        std::vector<double> error(trajectories_[s].y_nl);
        for (double& y : error) y = r - y;
        const auto integral = running_integral(error, h);
        all[1].insert(all[1].end(), integral.begin(), integral.end());
        if (problem_.with_derivative) {
            const double x0 = error[0] - (problem_.error_derivative ? r : 0);
            const auto derivative = filtered_derivative(error, h, Tf, x0);
            all[2].insert(all[2].end(), derivative.begin(), derivative.end());
        }
        all[0].insert(all[0].end(), error.begin(), error.end());
    }
    all[2].resize(all[0].size(), 0);
    return all;
}

double Remark6::J_of(const Gains& gains, const Signals& signals, std::vector<bool>* beyond) const {
    double J = 0;
    for (std::size_t i = 0; i < u_nl_.size(); ++i) {
        const double left = u_nl_[i] - (gains[0] * signals[0][i] + gains[1] * signals[1][i] + gains[2] * signals[2][i]);
        const bool out = at_limit_[i] * left < 0;
        if (beyond != nullptr) (*beyond)[i] = out;
        if (!out) J += weights_[i] * left * left;
    }
    return J;
}

double Remark6::J(const SettingsPoint& point) const {
    return J_of(gains_at(point), problem_.free_Tf() ? signals(point[3]) : fixed_, nullptr);
}

// Convex: where u_nl is at a limit only what falls short of it counts. Newton's method on the samples that count.
std::optional<Remark6::Found> Remark6::best_of_sign(double sign, double Tf, const Signals& signals,
                                                    const Bounds& bounds) const {
    const int n = problem_.with_derivative ? 3 : 2;
    std::vector<bool> beyond(u_nl_.size(), false), next(u_nl_.size());
    std::optional<Found> best;
    for (int round = 0; round < kLimitRounds; ++round) {
        robust::Matrix3 H{};
        robust::Vector3 g{};
        for (std::size_t i = 0; i < u_nl_.size(); ++i) {
            if (beyond[i]) continue;
            for (std::size_t j = 0; j < 3; ++j) {
                g[j] -= sign * weights_[i] * signals[j][i] * u_nl_[i];
                for (std::size_t k = 0; k <= j; ++k) H[j][k] += weights_[i] * signals[j][i] * signals[k][i];
            }
        }
        Gains scale{1, 1, 1};
        for (std::size_t j = 0; j < 3; ++j)
            if (H[j][j] > 0) scale[j] = 1 / std::sqrt(H[j][j]);
        for (std::size_t j = 0; j < 3; ++j) {
            g[j] *= scale[j];
            for (std::size_t k = 0; k <= j; ++k) H[k][j] = H[j][k] *= scale[j] * scale[k];
            H[j][j] += kRidge;
        }
        const auto solved = robust::solve_quadratic_program(n, H, g, half_planes(sign, bounds, scale, n == 3));
        if (!solved) return best;
        Gains gains{};
        for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) gains[j] = sign * scale[j] * solved->p[j];
        if (!(sign * gains[0] > 0) || !(sign * gains[1] > 0)) return best;
        const double J = J_of(gains, signals, &next);
        if (!best || J < best->J) {
            SettingsPoint point = {gains[0], gains[0] / gains[1]};
            if (n == 3) point.push_back(gains[2] / gains[0]);
            if (problem_.free_Tf()) point.push_back(Tf);
            best = Found{clipped(point, bounds), J};
        }
        if (next == beyond) break;
        beyond = next;
    }
    return best;
}

std::optional<Remark6::Found> Remark6::best_with(double Tf, const Bounds& bounds) const {
    const Signals own = problem_.free_Tf() ? signals(Tf) : Signals{};
    const Signals& used = problem_.free_Tf() ? own : fixed_;
    std::optional<Found> best;
    for (const double sign : {1.0, -1.0}) {
        if (!(sign > 0 ? bounds.high[0] > 0 : bounds.low[0] < 0)) continue;
        const auto found = best_of_sign(sign, Tf, used, bounds);
        if (found && (!best || found->J < best->J)) best = found;
    }
    return best;
}

std::optional<SettingsPoint> Remark6::best(const Bounds& bounds) const {
    std::optional<Found> best;
    const auto at = [&](double log_Tf) {
        const auto found = best_with(std::exp(log_Tf), bounds);
        if (found && (!best || found->J < best->J)) best = found;
        return found ? found->J : HUGE_VAL;
    };
    if (!problem_.free_Tf()) {
        best = best_with(problem_.Tf, bounds);
    } else {
        const double low = std::log(bounds.low[3]), high = std::log(bounds.high[3]);
        const double step = (high - low) / (kFilterScan - 1);
        std::array<double, kFilterScan> J{};
        for (int i = 0; i < kFilterScan; ++i) J[static_cast<std::size_t>(i)] = at(low + i * step);
        const auto least = std::ranges::min_element(J) - J.begin();
        double left = std::max(low, low + static_cast<double>(least - 1) * step);
        double right = std::min(high, low + static_cast<double>(least + 1) * step);
        double inner = right - kGolden * (right - left), outer = left + kGolden * (right - left);
        double J_inner = at(inner), J_outer = at(outer);
        for (int i = 0; i < kFilterSteps; ++i) {
            if (J_inner < J_outer) {
                right = outer, outer = inner, J_outer = J_inner;
                J_inner = at(inner = right - kGolden * (right - left));
            } else {
                left = inner, inner = outer, J_inner = J_outer;
                J_outer = at(outer = left + kGolden * (right - left));
            }
        }
    }
    if (!best) return std::nullopt;
    return best->point;
}

}  // namespace tunewright::emulation
