#include "engine/simulation/limited/limited_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/simulation/linear/run_setup.h"

namespace tunewright {
namespace {

using Index = std::size_t;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kLimitTolerance = 1e-12;  // relative distance from a limit within which the slope decides
constexpr double kRestLimitTolerance =
    1e-9;  // of u at rest: rounding of the linear solution; closer to a limit u counts as being at it
constexpr double kTrackingTimeShare = 0.1;  // of the plant's time: the tracking time for pure integral action

}  // namespace

std::optional<double> tracking_time(const ParallelPid& controller) {
    if (controller.Ki == 0) return std::numeric_limits<double>::infinity();
    if (controller.Kd != 0) return std::sqrt(std::abs(controller.Kd / controller.Ki));  // Ti Td = Kd/Ki
    if (controller.Kp != 0) return std::abs(controller.Kp / controller.Ki);
    return std::nullopt;
}

double tracking_time(const LinearPlant& plant, const ParallelPid& controller) {
    if (const auto time = tracking_time(controller)) return *time;
    const double time = plant.time_scale();
    return kTrackingTimeShare * (time > 0 ? time : 1 / std::abs(controller.Ki * plant.gain()));
}

double tracking_gain_of(const LinearPlant& plant, const ParallelPid& controller) {
    return controller.Ki != 0 ? 1 / (controller.Ki * tracking_time(plant, controller)) : 0;
}

LimitedLoop::LimitedLoop(DelaySystem system, double tracking_gain, const StepInputs& inputs,
                         const ActuatorLimits& limits)
    : system_(std::move(system)), in_(inputs), limits_(limits), tracking_gain_(tracking_gain) {
    below_ = equations(Region::below);
    inside_ = equations(Region::inside);
    above_ = equations(Region::above);
}

LimitedLoop::Equations LimitedLoop::equations(Region region) const {
    const double u = limit(region);
    if (region != Region::inside && !std::isfinite(u)) return {};
    const DelaySystem& s = system_;
    const Eigen::Index n = s.n, wide = n + 1;
    Equations e{std::vector<double>(Index(wide * wide), 0.0), s.G, std::vector<double>(Index(wide), 0.0)};
    e.G.push_back(s.Z);
    Eigen::Map<Matrix> F(e.F.data(), wide, wide);
    Eigen::Map<Eigen::VectorXd> G(e.G.data(), wide), b(e.b.data(), wide);
    const Eigen::Map<const Eigen::RowVectorXd> M(s.M.data(), n);
    F.topLeftCorner(n, n) = Eigen::Map<const Matrix>(s.F.data(), n, n);
    F.row(n).head(n) = Eigen::Map<const Eigen::RowVectorXd>(s.Y.data(), n);
    b.head(n) = in_.r * Eigen::Map<const Eigen::VectorXd>(s.H.data(), n);
    b[n] = -in_.r;
    if (region != Region::inside && s.integral_state >= 0) {
        const Eigen::Index row = s.integral_state;
        F.row(row).head(n) -= tracking_gain_ * M;
        G[row] -= tracking_gain_ * s.N;
        b[row] += tracking_gain_ * (u - s.R * in_.r);
    }
    if (delayed()) return e;
    // v = u + d follows at once: constant at a limit, (M x + R r + d)/(1 - N) within the limits.
    const double g = region == Region::inside ? 1 / (1 - s.N) : 0;
    const double v0 = region == Region::inside ? g * (s.R * in_.r + in_.d) : u + in_.d;
    F.leftCols(n) += (g * G) * M;
    b += v0 * G;
    G.setZero();
    return e;
}

double LimitedLoop::command(const std::vector<double>& x, double v) const {
    return dot(system_.M, x) + system_.N * v + system_.R * in_.r;
}

std::vector<double> LimitedLoop::rates(Region region, const std::vector<double>& x, double v) const {
    const Equations& e = region == Region::inside ? inside_ : region == Region::above ? above_ : below_;
    std::vector<double> rate(Index(system_.n));
    multiply(e.F, x, rate);
    for (Index i = 0; i < rate.size(); ++i) rate[i] += e.b[i] + e.G[i] * v;
    return rate;
}

LoopOutput LimitedLoop::output(Region region, const std::vector<double>& x, Signal v) const {
    const DelaySystem& s = system_;
    const bool inside = region == Region::inside;
    const std::vector<double> rate = rates(region, x, v.value);
    if (!delayed()) {
        v = {limit(region) + in_.d, 0};
        if (inside) v = {(command(x, 0) + in_.d) / (1 - s.N), dot(s.M, rate) / (1 - s.N)};
    }
    LoopOutput out;
    out.command = {command(x, v.value), dot(s.M, rate) + s.N * v.slope};
    out.y = {dot(s.Y, x) + s.Z * v.value, dot(s.Y, rate) + s.Z * v.slope};
    out.u = inside ? out.command : Signal{limit(region), 0};
    return out;
}

Region LimitedLoop::region(const std::vector<double>& x, Signal v) const {
    const Signal inside = output(Region::inside, x, v).command;
    const double band = kLimitTolerance * std::abs(inside.value);
    const bool at_max = std::abs(inside.value - limits_.max) <= band,
               at_min = std::abs(inside.value - limits_.min) <= band;
    const bool beyond_max = at_max ? inside.slope > 0 : inside.value > limits_.max;
    const bool beyond_min = at_min ? inside.slope < 0 : inside.value < limits_.min;
    if (beyond_max) return region_after(Region::inside, true);
    if (beyond_min) return region_after(Region::inside, false);
    return Region::inside;
}

Region LimitedLoop::region_after(Region before, bool at_max) const {
    // With N > 1 the algebraic loop has no solution beyond the limit that is crossed, but one at the other limit.
    if (!delayed() && system_.N > 1) return at_max ? Region::below : Region::above;
    if (before != Region::inside) return Region::inside;
    return at_max ? Region::above : Region::below;
}

ExactStep LimitedLoop::step(Region region, double h) const {
    const Equations& e = region == Region::inside ? inside_ : region == Region::above ? above_ : below_;
    return Propagator(states(), e.F, e.G, e.b, h).level(0);
}

SteadyState within_limits(const SteadyState& linear, const LinearPlant& plant, const ActuatorLimits& limits, double d) {
    SteadyState rest = linear;
    if (!linear.exists) return rest;
    rest.u = std::clamp(linear.u, limits.min, limits.max);
    if (std::abs(rest.u - linear.u) <= kRestLimitTolerance * std::abs(linear.u)) return rest;
    if (plant.integrators() > 0 || plant.unstable_poles() > 0) return {};
    return {.exists = true,
            .y = plant.integrators() < 0 ? 0 : plant.low_frequency_gain() * (rest.u + d),
            .u = rest.u,
            .at_limit = true};
}

}  // namespace tunewright
