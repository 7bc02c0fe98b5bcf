#include "engine/simulation/course/course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/loop/loop_builder.h"
#include "engine/simulation/limited/limited_course.h"
#include "engine/simulation/limited/limited_loop.h"
#include "engine/simulation/sampled/sampled_course.h"

namespace tunewright {
namespace {

using Index = std::size_t;

/// States behind those of the plant, in this order: q and its slope, the arriving d and its slope.
constexpr int kLoadStates = 4, kOutputLoad = 0, kInputLoad = 2;

/// The plant with the loads as further states: x' = A x + B (v + d), y = C x + D (v + d) + q.
Realisation with_loads(const Realisation& plant) {
    const int n = plant.n, wide = n + kLoadStates;
    Realisation out{wide, std::vector<double>(Index(wide * wide), 0.0), plant.B, plant.C, plant.D};
    out.B.resize(Index(wide), 0.0);
    out.C.resize(Index(wide), 0.0);
    const auto A = [&](int i, int j) -> double& { return out.A[Index(i * wide + j)]; };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) A(i, j) = plant.A[Index(i * n + j)];
        A(i, n + kInputLoad) = plant.B[Index(i)];
    }
    for (const int load : {kOutputLoad, kInputLoad}) A(n + load, n + load + 1) = 1;
    out.C[Index(n + kOutputLoad)] = 1;
    out.C[Index(n + kInputLoad)] = plant.D;
    return out;
}

/// The loop with the set point and its slope as its last two states.
DelaySystem with_setpoint(const DelaySystem& loop) {
    const int n = loop.n, wide = n + 2;
    DelaySystem out = loop;
    out.n = wide;
    out.F.assign(Index(wide * wide), 0.0);
    const auto F = [&](int i, int j) -> double& { return out.F[Index(i * wide + j)]; };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) F(i, j) = loop.F[Index(i * n + j)];
        F(i, n) = loop.H[Index(i)];
    }
    F(n, n + 1) = 1;
    out.H.assign(Index(wide), 0.0);
    for (auto* vector : {&out.G, &out.M, &out.Y}) vector->resize(Index(wide), 0.0);
    out.M[Index(n)] = std::exchange(out.R, 0.0);
    return out;
}

std::vector<StateJump> in_order(std::vector<StateJump> jumps) {
    std::stable_sort(jumps.begin(), jumps.end(), [](const StateJump& a, const StateJump& b) { return a.t < b.t; });
    return jumps;
}

/// Jumps of the two states of a signal, value first, that rises by `size` over `duration` from t on.
void add_rise(std::vector<StateJump>& jumps, int state, double t, double size, double duration) {
    if (duration <= 0) {
        jumps.push_back({t, state, size});
        return;
    }
    jumps.push_back({t, state + 1, size / duration});
    jumps.push_back({t + duration, state + 1, -size / duration});
}

/// `n`: states of the plant alone. `L`: its dead time.
void add_load(std::vector<StateJump>& jumps, const Course& course, int n, double L) {
    if (!course.load) return;
    const CourseLoad& load = *course.load;
    const int state = n + (load.at_output ? kOutputLoad : kInputLoad);
    const double start = load.start + (load.at_output ? 0 : L);
    add_rise(jumps, state, start, load.size, load.shape == LoadShape::ramp ? load.duration : 0);
    if (load.shape == LoadShape::pulse) jumps.push_back({start + load.duration, state, -load.size});
    // A node at the change itself, from which the figures of the load count.
    jumps.push_back({load.start, state, 0});
}

/// The part of the load that remains at the end.
double remaining(const Course& course, bool at_output) {
    if (!course.load || course.load->at_output != at_output || course.load->shape == LoadShape::pulse) return 0;
    return course.load->size;
}

/// 0 = the loop's equations without time: y = P(0) (u + d) + q and the control law at rest.
SteadyState rest_of(const LinearPlant& plant, const ParallelPid& gains, const Course& course,
                    const ActuatorLimits& limits) {
    const double r = course.r, d = remaining(course, false), q = remaining(course, true);
    const double K = plant.integrators() < 0 ? 0 : plant.low_frequency_gain();
    const bool integrates = plant.integrators() > 0;
    SteadyState rest;
    if (gains.Ki != 0) {
        if (K == 0) return {};
        rest = {.exists = true, .y = r, .u = (integrates ? 0 : (r - q) / K) - d};
    } else if (integrates) {
        if (gains.Kp == 0) return {};
        rest = {.exists = true, .y = gains.b * r + d / gains.Kp, .u = -d};
    } else {
        const double u0 = gains.Kp * gains.b * r, y = (K * (u0 + d) + q) / (1 + K * gains.Kp);
        rest = {.exists = std::isfinite(y), .y = y, .u = u0 - gains.Kp * y};
    }
    rest = within_limits(rest, plant, limits, d);
    if (rest.at_limit) rest.y += q;
    return rest;
}

StepInputs sizes_of(const Course& course) {
    StepInputs sizes{std::abs(course.r), 0};
    if (course.load) (course.load->at_output ? sizes.r : sizes.d) += std::abs(course.load->size);
    return sizes;
}

constexpr ActuatorLimits kUnlimited{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

}  // namespace

double setpoint_at(const Course& course, double t) {
    return t >= course.ramp_time ? course.r : course.r * t / course.ramp_time;
}

double last_change(const Course& course) {
    if (!course.load) return course.ramp_time;
    const CourseLoad& load = *course.load;
    return std::max(course.ramp_time, load.start + (load.shape == LoadShape::step ? 0 : load.duration));
}

StepResponse simulate_course(const LinearPlant& plant, const ParallelPid& controller, const Course& course,
                             const ActuatorLimits& limits, const ResponseOptions& options) {
    const Realisation augmented = with_loads(plant.realisation());
    const DelaySystem loop = LoopBuilder(augmented, plant.dead_time(), controller).build();
    LimitedCourse limited{.system = with_setpoint(loop),
                          .jumps = {},
                          .rest = rest_of(plant, controller, course, limits),
                          .largest = sizes_of(course)};
    add_rise(limited.jumps, loop.n, 0, course.r, course.ramp_time);
    add_load(limited.jumps, course, plant.realisation().n, plant.dead_time());
    limited.jumps = in_order(std::move(limited.jumps));
    return simulate_limited_course(plant, controller, limited, limits, options);
}

StepResponse simulate_course(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                             const Course& course, const SampledOptions& options) {
    SampledCourse sampled{.plant = with_loads(plant.realisation()),
                          .jumps = {},
                          .setpoint = [course](double t) { return setpoint_at(course, t); },
                          .rest = rest_of(plant, law.gains, course, limits.output.value_or(kUnlimited)),
                          .largest = sizes_of(course),
                          .last_change = last_change(course)};
    // A node where the set point's ramp ends.
    if (course.ramp_time > 0) sampled.jumps.push_back({course.ramp_time, plant.realisation().n, 0});
    add_load(sampled.jumps, course, plant.realisation().n, plant.dead_time());
    if (course.load) sampled.last_change += plant.dead_time();
    sampled.jumps = in_order(std::move(sampled.jumps));
    return simulate_sampled_course(plant, law, limits, sampled, options);
}

}  // namespace tunewright
