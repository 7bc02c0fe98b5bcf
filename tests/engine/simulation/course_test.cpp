// Loops whose inputs change while they run: compared with a simple simulation in tiny steps, with superposition, and
// with the program run step by step.
#include "engine/simulation/course/course.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/simulation/limited/limited_response.h"
#include "engine/simulation/linear/indices.h"
#include "tests/engine/simulation/plain_limited_loop.h"

namespace tunewright {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

LinearPlant plant_of(const Plant& plant) { return *LinearPlant::make(plant); }

double rise(double t, double start, double duration) {
    if (t < start) return 0;
    return duration > 0 ? std::min(1.0, (t - start) / duration) : 1;
}

double load_at(const CourseLoad& load, double t) {
    if (load.shape == LoadShape::ramp) return load.size * rise(t, load.start, load.duration);
    if (load.shape == LoadShape::pulse && t >= load.start + load.duration) return 0;
    return t >= load.start ? load.size : 0;
}

PlainInputs plain(const Course& course) {
    const auto load = [course](bool at_output) {
        return [course, at_output](double t) {
            return course.load && course.load->at_output == at_output ? load_at(*course.load, t) : 0.0;
        };
    };
    return {[course](double t) { return course.r * rise(t, 0, course.ramp_time); }, load(false), load(true)};
}

struct CourseCase {
    const char* name;
    Plant plant;
    ParallelPid gains;
    Course course;
    ActuatorLimits limits;
    double horizon;
};

const Filter kSlowFilter{FilterType::measurement_second_order, 0.2}, kOnDerivative{FilterType::derivative, 0.1};

CourseLoad load(double size, double start, LoadShape shape = LoadShape::step, double duration = 0,
                bool at_output = false) {
    return {size, at_output, shape, duration, start};
}

std::vector<CourseCase> course_cases() {
    const Plant lag = Fopdt{.K = 2, .T = 3, .L = 0.5}, second = Sopdt{.K = 1, .T1 = 2, .T2 = 0.7, .L = 0.3};
    const ParallelPid PI{.Kp = 0.9, .Ki = 0.3}, PID{.Kp = 3, .Ki = 1.2, .Kd = 1.5, .filter = kSlowFilter};
    return {
        {"step at once, load at the input", lag, PI, {1, 0, load(0.5, 20)}, {-1, 0.8}, 50},
        {"ramp, load at the input", lag, PI, {1, 5, load(-0.4, 20)}, {-1, 0.8}, 50},
        {"ramp that saturates, pulse", lag, PI, {1.5, 1, load(0.5, 20, LoadShape::pulse, 3)}, {0, 0.8}, 50},
        {"ramp of the load", second, PID, {1, 4, load(0.6, 20, LoadShape::ramp, 6)}, {-0.2, 1.3}, 50},
        {"step at the output", second, PID, {1, 4, load(0.3, 20, LoadShape::step, 0, true)}, {-0.2, 1.3}, 50},
        {"pulse at the output", second, PID, {1, 0, load(0.3, 20, LoadShape::pulse, 2, true)}, {-0.2, 1.3}, 50},
        {"ramp at the output", second, PID, {1, 4, load(0.5, 20, LoadShape::ramp, 5, true)}, {-0.2, 1.3}, 50},
        {"derivative filter with set-point weights",
         second,
         {.Kp = 3, .Ki = 1.2, .Kd = 1.5, .b = 0.7, .c = 1, .filter = kOnDerivative},
         {1, 3, load(0.4, 20, LoadShape::step, 0, true)},
         {-2, 2},
         50},
        {"no dead time", Fopdt{.K = 2, .T = 3, .L = 0}, PI, {1, 2, load(-0.5, 20, LoadShape::pulse, 4)}, {0, 0.7}, 50},
        {"integrating plant", Ipdt{.K = 0.5, .L = 0.5}, {.Kp = 0.8, .Ki = 0.1}, {2, 3, load(-0.3, 40)}, {-1, 0.6}, 90},
        {"proportional action only", lag, {.Kp = 1.5}, {1, 2, load(0.3, 20)}, {-1, 1}, 40},
        {"load before the ramp has ended", lag, PI, {1, 20, load(0.3, 10)}, {-1, 2}, 50},
        {"load alone", lag, PI, {0, 0, load(1.5, 0)}, {-1, 1}, 40},
    };
}

double tracking(const LinearPlant& plant, const ParallelPid& gains) { return tracking_time(plant, gains); }

double sampled_y(const StepResponse& response, double horizon, int i, int n) {
    return sampled(response.nodes, horizon, n + 1)[std::size_t(i)].first;
}

TEST(Course, AgreesWithAPlainSimulationInTinySteps) {
    for (const CourseCase& c : course_cases()) {
        SCOPED_TRACE(c.name);
        const LinearPlant plant = plant_of(c.plant);
        const StepResponse response =
            simulate_course(plant, c.gains, c.course, c.limits, {.tail = {}, .horizon = c.horizon});
        const Figures expected =
            PlainSimulation(plant, c.gains, plain(c.course), c.limits, tracking(plant, c.gains)).run(c.horizon, 1e-3);
        ASSERT_EQ(response.nodes.back().t, c.horizon);
        for (int i = 1; i <= 10; ++i)
            EXPECT_NEAR(sampled_y(response, c.horizon, i, 10), expected.y[std::size_t(i - 1)], 1e-3) << i;
        double max_u = -kNone, at_max = 0;
        for (std::size_t i = 0; i < response.nodes.size(); ++i) {
            max_u = std::max(max_u, response.nodes[i].u);
            if (i > 0 && response.nodes[i].u >= c.limits.max && response.nodes[i - 1].u >= c.limits.max)
                at_max += response.nodes[i].t - response.nodes[i - 1].t;
        }
        EXPECT_NEAR(max_u, expected.max_u, 2e-3);
        EXPECT_NEAR(at_max, expected.time_at_max, 0.02);
    }
}

// Without limits the loop is linear: the response is a sum of step responses, each from its own time on, and that to a
// ramp is their integral.
TEST(Course, IsTheSuperpositionOfStepsWithoutLimits) {
    const LinearPlant plant = plant_of(Sopdt{.K = 1.5, .T1 = 4, .T2 = 1, .L = 0.8});
    const ParallelPid gains{.Kp = 1.2, .Ki = 0.3, .Kd = 1, .b = 0.6, .filter = kSlowFilter};
    const StepResponse of_r = simulate_linear(plant, gains, {1, 0}, {.tolerance = 1e-8, .tail = {}, .horizon = 60.0}),
                       of_d = simulate_linear(plant, gains, {0, 1}, {.tolerance = 1e-8, .tail = {}, .horizon = 60.0});
    const Course course{2, 6, load(0.7, 25, LoadShape::pulse, 5)};
    const StepResponse response =
        simulate_course(plant, gains, course, {-kNone, kNone}, {.tolerance = 1e-8, .tail = {}, .horizon = 60.0});
    const auto y_of = [](const StepResponse& step, double t) {
        return t <= 0 ? 0.0 : sampled(step.nodes, t, 2).back().first;
    };
    for (double t = 1; t <= 60; t += 3.7) {
        // The mean of the step response over the ramp's duration, by Simpson's rule.
        constexpr int kParts = 400;
        double mean = 0;
        for (int i = 0; i <= kParts; ++i) {
            const double weight = i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2;
            mean += weight * y_of(of_r, t - course.ramp_time * i / kParts) / (3 * kParts);
        }
        const double expected = course.r * mean + 0.7 * (y_of(of_d, t - 25) - y_of(of_d, t - 30));
        EXPECT_NEAR(sampled(response.nodes, t, 2).back().first, expected, 2e-5) << t;
    }
}

// In steady state u must carry what is left of the load, whatever its place and shape.
TEST(Course, RestsWhereTheEquationsOfRestSay) {
    const double K = 2;
    const LinearPlant plant = plant_of(Fopdt{.K = K, .T = 3, .L = 0.5});
    for (const bool at_output : {false, true})
        for (const LoadShape shape : {LoadShape::step, LoadShape::pulse, LoadShape::ramp}) {
            const Course course{1, 2, load(0.4, 20, shape, 3, at_output)};
            const double left = shape == LoadShape::pulse ? 0 : 0.4;
            const double u = at_output ? (1 - left) / K : 1 / K - left;
            for (const double limit : {10.0, 0.25}) {
                const StepResponse response =
                    simulate_course(plant, {.Kp = 0.9, .Ki = 0.3}, course, {-limit, limit}, {});
                ASSERT_TRUE(response.settles);
                const double held = std::min(u, limit);
                EXPECT_NEAR(response.nodes.back().u, held, 1e-5);
                EXPECT_NEAR(response.u_final, held, 1e-12);
                EXPECT_NEAR(response.nodes.back().y, K * (held + (at_output ? 0 : left)) + (at_output ? left : 0),
                            1e-5);
            }
        }
}

// The sampled loop: plant and inputs in tiny Euler steps, the program of the contract called at its samples.
TEST(SampledCourse, AgreesWithTheProgramCalledStepByStep) {
    for (const CourseCase& c : course_cases()) {
        if (c.gains.filter.type == FilterType::derivative) continue;
        SCOPED_TRACE(c.name);
        const LinearPlant plant = plant_of(c.plant);
        const SampledPid law{.gains = c.gains, .Ts = 0.25};
        const ProgramLimits limits{.output = c.limits};
        const StepResponse response = simulate_course(plant, law, limits, c.course, {.horizon = c.horizon});
        PidProgram program(law, limits);
        const PlainInputs in = plain(c.course);
        constexpr double dt = 5e-4;
        const int per_sample = int(std::lround(law.Ts / dt)), lag = int(std::lround(plant.dead_time() / dt)),
                  steps = int(std::lround(c.horizon / dt));
        const Realisation& p = plant.realisation();
        std::vector<double> x(std::size_t(p.n), 0.0), w, y_tenths;
        double u = 0;
        for (int k = 0; k <= steps; ++k) {
            const double t = k * dt;
            double y = in.q(t);
            for (int i = 0; i < p.n; ++i) y += p.C[std::size_t(i)] * x[std::size_t(i)];
            if (k > 0 && k % (steps / 10) == 0) y_tenths.push_back(y);
            // A jump at the time of a sample comes after it.
            const double seen = y - in.q(t) + in.q(t - dt / 2);
            if (k % per_sample == 0) u = program.step(in.r(t), seen);
            w.push_back(u + in.d(t));
            const double v = k >= lag ? w[std::size_t(k - lag)] : 0;
            std::vector<double> rate(x.size());
            for (std::size_t i = 0; i < x.size(); ++i) {
                rate[i] = p.B[i] * v;
                for (std::size_t j = 0; j < x.size(); ++j) rate[i] += p.A[i * x.size() + j] * x[j];
            }
            for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * rate[i];
        }
        ASSERT_GE(y_tenths.size(), 10u);
        for (int i = 1; i < 10; ++i)
            EXPECT_NEAR(sampled_y(response, c.horizon, i, 10), y_tenths[std::size_t(i - 1)], 2e-3) << i;
    }
}

TEST(SampledCourse, ApproachesTheContinuousLoopAsTheSampleTimeFalls) {
    const CourseCase c = course_cases()[0];
    const LinearPlant plant = plant_of(c.plant);
    const ActuatorLimits wide{-100, 100};
    const StepResponse continuous = simulate_course(plant, c.gains, c.course, wide, {.tail = {}, .horizon = c.horizon});
    double before = kNone;
    for (const double Ts : {0.4, 0.1, 0.025}) {
        const StepResponse with_samples = simulate_course(plant, SampledPid{.gains = c.gains, .Ts = Ts},
                                                          {.output = wide}, c.course, {.horizon = c.horizon});
        double worst = 0;
        for (int i = 1; i <= 200; ++i)
            worst = std::max(
                worst, std::abs(sampled_y(with_samples, c.horizon, i, 200) - sampled_y(continuous, c.horizon, i, 200)));
        EXPECT_LT(worst, 0.4 * before);
        before = worst;
    }
    EXPECT_LT(before, 0.02);
}

// Nodes lie where an input changes, so that figures can count from there.
TEST(Course, HasNodesWhereAnInputChanges) {
    const LinearPlant plant = plant_of(Fopdt{.K = 2, .T = 3, .L = 0.5});
    const ParallelPid gains{.Kp = 0.9, .Ki = 0.3};
    const Course course{1, 3.3, load(0.4, 17.7, LoadShape::pulse, 2.1)};
    const auto has_node = [](const StepResponse& response, double t) {
        return std::ranges::any_of(response.nodes, [t](const auto& node) { return std::abs(node.t - t) < 1e-9; });
    };
    const StepResponse continuous = simulate_course(plant, gains, course, {-1, 1}, {}),
                       program = simulate_course(plant, SampledPid{.gains = gains, .Ts = 0.25}, {}, course, {});
    for (const StepResponse* response : {&continuous, &program}) {
        EXPECT_TRUE(response->settles);
        for (const double t : {3.3, 17.7, 17.7 + 0.5, 17.7 + 2.1 + 0.5}) EXPECT_TRUE(has_node(*response, t)) << t;
    }
}

}  // namespace
}  // namespace tunewright
