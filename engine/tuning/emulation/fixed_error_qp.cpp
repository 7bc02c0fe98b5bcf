#include "engine/tuning/emulation/fixed_error_qp.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>
#include <vector>

namespace tunewright::emulation {

namespace {

constexpr double kSeriesUpTo = 3;  // h/Tf above which the recursion is more accurate than the series
constexpr int kSeriesTerms = 40;

using Four = std::array<double, 4>;

// Coefficients in powers of sigma of the cubic with value 1 at position `at` and 0 at the other three of -first, 1 -
// first, ...
Four lagrange(int at, int first) {
    Four c{1, 0, 0, 0};
    int degree = 0;
    double scale = 1;
    for (int j = 0; j < 4; ++j) {
        if (j == at) continue;
        const double root = j - first;
        for (int k = ++degree; k > 0; --k) {
            const auto i = static_cast<std::size_t>(k);
            c[i] = c[i - 1] - root * c[i];
        }
        c[0] *= -root;
        scale *= at - j;
    }
    for (double& value : c) value /= scale;
    return c;
}

// Weights of four neighbours in an integral over one interval, from the integrals of sigma^k over it; `first` of them
// are before the interval's start.
Four interval_weights(const Four& moments, int first) {
    Four weights{};
    for (int at = 0; at < 4; ++at) {
        const Four c = lagrange(at, first);
        for (std::size_t k = 0; k < 4; ++k) weights[static_cast<std::size_t>(at)] += c[k] * moments[k];
    }
    return weights;
}

// a int_0^1 e^(-a (1 - sigma)) sigma^k d sigma for k = 0 to 3.
Four filter_moments(double a) {
    Four moments{};
    if (a > kSeriesUpTo) {
        moments[0] = -std::expm1(-a);
        for (std::size_t k = 1; k < 4; ++k) moments[k] = 1 - static_cast<double>(k) / a * moments[k - 1];
        return moments;
    }
    for (int k = 0; k < 4; ++k) {
        double term = 1.0 / (k + 1), sum = term;
        for (int j = 1; j < kSeriesTerms; ++j) sum += term *= -a / (j + k + 1);
        moments[static_cast<std::size_t>(k)] = a * sum;
    }
    return moments;
}

// Calls `step(i, integral)` with the weighted integral over each interval i.
void over_intervals(const std::vector<double>& samples, const Four& moments,
                    const std::function<void(std::size_t, double)>& step) {
    const std::array<Four, 3> weights = {interval_weights(moments, 0), interval_weights(moments, 1),
                                         interval_weights(moments, 2)};
    const std::size_t last = samples.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const std::size_t before = i == 0 ? 0 : i + 1 == last ? 2 : 1;
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += weights[before][k] * samples[i - before + k];
        step(i, sum);
    }
}

// The integral from the first sample, by cubics; at least four samples at distance h.
std::vector<double> running_integral(const std::vector<double>& samples, double h) {
    std::vector<double> integral(samples.size(), 0);
    over_intervals(samples, {1, 1.0 / 2, 1.0 / 3, 1.0 / 4},
                   [&](std::size_t i, double part) { integral[i + 1] = integral[i] + h * part; });
    return integral;
}

// (e - x)/Tf with Tf x' = e - x from x0: the derivative of e after a first-order filter.
std::vector<double> filtered_derivative(const std::vector<double>& e, double h, double Tf, double x0) {
    std::vector<double> derivative(e.size());
    const double a = h / Tf, decay = std::exp(-a);
    double x = x0;
    derivative[0] = (e[0] - x) / Tf;
    over_intervals(e, filter_moments(a), [&](std::size_t i, double part) {
        x = decay * x + part;
        derivative[i + 1] = (e[i + 1] - x) / Tf;
    });
    return derivative;
}

constexpr double kLimitTolerance = 1e-9;    // relative
constexpr double kRidge = 1e-13;            // of the scaled normal matrix
constexpr int kLimitRounds = 30;            // rounds until the set of samples beyond a limit no longer changes
constexpr int kFilterScan = 9;              // scanned values of a free filter
constexpr int kFilterBits = 26;             // bits of ln Tf between them: half of the digits, the accuracy of a minimum
constexpr double kJOfNoController = 1e100;  // J of a filter without a controller

using Gains = Eigen::Vector3d;

Gains gains_at(const SettingsPoint& point) {
    return {point[0], point[0] / point[1], point.size() > 2 ? point[0] * point[2] : 0};
}

// The bounds on Kp, Ti, Td as half-planes of sign (Kp, Kp/Ti, Kp Td), Kp > 0 there; unknowns scaled.
void add_half_planes(optimise::SmallProgram& program, double sign, const Bounds& bounds, const Gains& scale) {
    const double low = std::max(0.0, sign > 0 ? bounds.low[0] : -bounds.high[0]);
    const double high = sign > 0 ? bounds.high[0] : -bounds.low[0];
    const auto add = [&](const Gains& normal, double bound) { program.add(normal.head(program.g.size()), bound); };
    add({scale[0], 0, 0}, high);
    add({-scale[0], 0, 0}, -low);
    add({-scale[0], bounds.low[1] * scale[1], 0}, 0);
    add({scale[0], -bounds.high[1] * scale[1], 0}, 0);
    if (program.g.size() < 3) return;
    add({bounds.low[2] * scale[0], 0, -scale[2]}, 0);
    add({-bounds.high[2] * scale[0], 0, scale[2]}, 0);
}

}  // namespace

FixedErrorQp::FixedErrorQp(const EmulationProblem& problem, const std::vector<Trajectory>& trajectories)
    : problem_(problem), trajectories_(trajectories) {
    const std::vector<double> simpson = simpson_weights(problem);
    for (std::size_t s = 0; s < trajectories.size(); ++s) {
        const NonlinearSystem& system = *problem.scenarios[s].system;
        const double low = system.u_min() - system.u_nominal(), high = system.u_max() - system.u_nominal();
        const double near = kLimitTolerance * (std::abs(system.u_nominal()) + std::sqrt(trajectories[s].u_size));
        for (std::size_t i = 0; i < simpson.size(); ++i) {
            const double u = trajectories[s].u_nl[i];
            weights_.push_back(problem.wu * simpson[i] / static_cast<double>(trajectories.size()));
            u_nl_.push_back(u);
            at_limit_.push_back(u >= high - near ? 1 : u <= low + near ? -1 : 0);
        }
    }
    fixed_ = signals(problem.Tf);
}

FixedErrorQp::Signals FixedErrorQp::signals(double Tf) const {
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

double FixedErrorQp::J_of(const Gains& gains, const Signals& signals, std::vector<bool>* beyond) const {
    double J = 0;
    for (std::size_t i = 0; i < u_nl_.size(); ++i) {
        const double left = u_nl_[i] - (gains[0] * signals[0][i] + gains[1] * signals[1][i] + gains[2] * signals[2][i]);
        const bool out = at_limit_[i] * left < 0;
        if (beyond != nullptr) (*beyond)[i] = out;
        if (!out) J += weights_[i] * left * left;
    }
    return J;
}

double FixedErrorQp::J(const SettingsPoint& point) const {
    return J_of(gains_at(point), problem_.free_Tf() ? signals(point[3]) : fixed_, nullptr);
}

// Convex: if u_nl is at a limit, only values inside the limit count. Newton's method with the samples that count.
std::optional<FixedErrorQp::BestPoint> FixedErrorQp::best_of_sign(double sign, double Tf, const Signals& signals,
                                                                  const Bounds& bounds) const {
    const int n = problem_.with_derivative ? 3 : 2;
    std::vector<bool> beyond(u_nl_.size(), false), next(u_nl_.size());
    std::optional<BestPoint> best;
    for (int round = 0; round < kLimitRounds; ++round) {
        Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
        Gains g = Gains::Zero();
        for (std::size_t i = 0; i < u_nl_.size(); ++i) {
            if (beyond[i]) continue;
            const Gains at(signals[0][i], signals[1][i], signals[2][i]);
            g -= sign * weights_[i] * u_nl_[i] * at;
            H += weights_[i] * at * at.transpose();
        }
        Gains scale = Gains::Ones();
        for (int j = 0; j < 3; ++j)
            if (H(j, j) > 0) scale[j] = 1 / std::sqrt(H(j, j));
        H = (scale.asDiagonal() * H * scale.asDiagonal()).eval() + kRidge * Eigen::Matrix3d::Identity();
        optimise::SmallProgram program(n, 6);
        program.H = H.topLeftCorner(n, n);
        program.g = g.cwiseProduct(scale).head(n);
        add_half_planes(program, sign, bounds, scale);
        const auto solved = solve(program);
        if (!solved) return best;
        Gains gains = Gains::Zero();
        gains.head(n) = sign * scale.head(n).cwiseProduct(solved->x);
        if (!(sign * gains[0] > 0) || !(sign * gains[1] > 0)) return best;
        const double J = J_of(gains, signals, &next);
        if (!best || J < best->J) {
            SettingsPoint point = {gains[0], gains[0] / gains[1]};
            if (n == 3) point.push_back(gains[2] / gains[0]);
            if (problem_.free_Tf()) point.push_back(Tf);
            best = BestPoint{clipped(point, bounds), J};
        }
        if (next == beyond) break;
        beyond = next;
    }
    return best;
}

std::optional<FixedErrorQp::BestPoint> FixedErrorQp::best_with(double Tf, const Bounds& bounds) const {
    const Signals own = problem_.free_Tf() ? signals(Tf) : Signals{};
    const Signals& used = problem_.free_Tf() ? own : fixed_;
    std::optional<BestPoint> best;
    for (const double sign : {1.0, -1.0}) {
        if (!(sign > 0 ? bounds.high[0] > 0 : bounds.low[0] < 0)) continue;
        const auto found = best_of_sign(sign, Tf, used, bounds);
        if (found && (!best || found->J < best->J)) best = found;
    }
    return best;
}

std::optional<SettingsPoint> FixedErrorQp::best(const Bounds& bounds) const {
    std::optional<BestPoint> best;
    const auto at = [&](double log_Tf) {
        const auto found = best_with(std::exp(log_Tf), bounds);
        if (found && (!best || found->J < best->J)) best = found;
        return found ? found->J : kJOfNoController;
    };
    if (!problem_.free_Tf()) {
        best = best_with(problem_.Tf, bounds);
    } else {
        const double low = std::log(bounds.low[3]), high = std::log(bounds.high[3]);
        const double step = (high - low) / (kFilterScan - 1);
        std::array<double, kFilterScan> J{};
        for (int i = 0; i < kFilterScan; ++i) J[static_cast<std::size_t>(i)] = at(low + i * step);
        const auto min = std::ranges::min_element(J) - J.begin();
        const double left = std::max(low, low + static_cast<double>(min - 1) * step);
        const double right = std::min(high, low + static_cast<double>(min + 1) * step);
        boost::math::tools::brent_find_minima(at, left, right, kFilterBits);  // `at` stores the best
    }
    if (!best) return std::nullopt;
    return best->point;
}

}  // namespace tunewright::emulation
