#include "engine/simulation/sampled/sampled_response.h"

#include <gtest/gtest.h>

#include "engine/simulation/linear/indices.h"
#include "tests/engine/loop/sampled_cases.h"

namespace tunewright {
namespace {

using namespace test;

double to_multiple(double value, double resolution) {
    return resolution > 0 ? std::round(value / resolution) * resolution : value;
}

/// The program of pid_program.h written out: for a PID without a filter of the measurement, derivative as a difference
/// or filtered by the backward rule, integral by the backward or the trapezoidal rule.
struct OwnProgram {
    SampledPid law;
    ProgramLimits limits;
    double I = 0, D = 0, f_last = 0, e_last = 0, P_last = 0, u_last = 0;

    double step(double r, double y_true) {
        const ParallelPid& g = law.gains;
        double y = to_multiple(y_true, limits.y_resolution);
        if (std::abs(r - y) < limits.dead_band) y = r;
        const double e = r - y, f = g.c * r - y, P = g.Kp * (g.b * r - y), D_last = D;
        const double Tf = g.filter.type == FilterType::derivative ? g.filter.Tf : 0;
        D = (Tf * D + g.Kd * (f - f_last)) / (Tf + law.Ts);
        const double dI = g.Ki * law.Ts * (law.integral == IntegralRule::trapezoidal ? (e + e_last) / 2 : e);
        const double low = limits.output ? limits.output->min : -INFINITY;
        const double high = limits.output ? limits.output->max : INFINITY;
        double u = 0;
        if (law.velocity) {
            u = std::clamp(u_last + (P - P_last) + dI + (D - D_last), low, high);
        } else {
            const double wanted = P + I + dI + D;
            if (!((wanted > high && dI > 0) || (wanted < low && dI < 0))) I += dI;
            u = std::clamp(wanted, low, high);
        }
        f_last = f, e_last = e, P_last = P, u_last = u;
        const double given = to_multiple(u, limits.u_resolution);  // within the limits too
        return given > high ? given - limits.u_resolution : given < low ? given + limits.u_resolution : given;
    }
};

struct Trace {
    std::vector<double> y, u;  // y in the middle of every part of a period, u of each sample
};

constexpr int kPartsOfTrace = 40;

Trace own_trace(const OwnPlant& plant, double dead_time, OwnProgram program, double r, double d, int samples) {
    const double Ts = program.law.Ts;
    const OwnPlant::Motion half = plant.over(Ts / kPartsOfTrace / 2);
    const auto parts_of = [&](double time) { return std::lround(time / Ts * kPartsOfTrace); };
    const long lag_load = parts_of(dead_time), lag = lag_load + parts_of(program.law.computation_delay);
    Trace trace;
    std::vector<double> x(plant.order(), 0.0);
    double v = 0;
    for (int k = 0; k < samples; ++k) {
        trace.u.push_back(program.step(r, plant.output(x, v)));
        for (int j = 0; j < kPartsOfTrace; ++j) {
            const long g = long(k) * kPartsOfTrace + j;
            v = (g >= lag ? trace.u[std::size_t((g - lag) / kPartsOfTrace)] : 0) + (g >= lag_load ? d : 0);
            OwnPlant::move(half, x, v);
            trace.y.push_back(plant.output(x, v));
            OwnPlant::move(half, x, v);
        }
    }
    return trace;
}

/// Compares both over `samples` periods; y between nodes by their cubics.
void compare(const Plant& plant, const OwnPlant& own, const SampledPid& law, const ProgramLimits& limits,
             const StepInputs& in, int samples) {
    const LinearPlant linear = *LinearPlant::make(plant);
    const double Ts = law.Ts, horizon = samples * Ts;
    const StepResponse response = simulate_sampled(linear, law, limits, in, {.horizon = horizon});
    ASSERT_TRUE(response.settles);
    EXPECT_NEAR(response.nodes.back().t, horizon, 1e-9 * horizon);
    const Trace trace = own_trace(own, dead_time(plant), {law, limits}, in.r, in.d, samples);
    double largest = 0, largest_u = 0, dy = 0, du = 0;
    for (const double y : trace.y) largest = std::max(largest, std::abs(y));
    for (const double u : trace.u) largest_u = std::max(largest_u, std::abs(u));
    const auto values = sampled(response.nodes, horizon, 2 * samples * kPartsOfTrace + 1);
    const long lag = std::lround(law.computation_delay / Ts * kPartsOfTrace);
    for (std::size_t i = 0; i < trace.y.size(); ++i) {
        const long given = long(i) - lag;
        const double u = given >= 0 ? trace.u[std::size_t(given / kPartsOfTrace)] : 0;
        dy = std::max(dy, std::abs(trace.y[i] - values[2 * i + 1].first));
        du = std::max(du, std::abs(u - values[2 * i + 1].second));
    }
    EXPECT_LT(dy, 3e-6 * largest);
    EXPECT_LT(du, 1e-9 * largest_u);
}

SampledPid pid(double Kp, double Ki, double Kd, double Ts) {
    return {.gains = {.Kp = Kp, .Ki = Ki, .Kd = Kd, .b = 0.8, .c = 0.3, .filter = {FilterType::derivative, 0.17}},
            .Ts = Ts};
}

const Plant kLags = Sopdt{.K = 2, .T1 = 1, .T2 = 0.4, .L = 0.35};
const OwnPlant kOwnLags({2}, lags({1, 0.4}));

TEST(SampledResponse, IsThatOfThePlainLoopWithLimitsResolutionsAndDeadBand) {
    int i = 0;
    for (const bool velocity : {false, true})
        for (const ProgramLimits& limits :
             {ProgramLimits{}, ProgramLimits{.output = ActuatorLimits{-0.15, 0.71}},
              ProgramLimits{.output = ActuatorLimits{-0.5, 0.62}, .u_resolution = 0.01037},
              ProgramLimits{.output = {}, .u_resolution = 0.0711}, ProgramLimits{.output = {}, .y_resolution = 0.0313},
              ProgramLimits{.output = {}, .dead_band = 0.057},
              ProgramLimits{.output = ActuatorLimits{-1, 0.9},
              .u_resolution = 0.031,
              .y_resolution = 0.0091,
              .dead_band = 0.021}})
            for (const StepInputs in : {StepInputs{1.013, 0}, StepInputs{0, 0.217}, StepInputs{-0.2, -0.1}}) {
                SCOPED_TRACE(std::to_string(++i));
                SampledPid law = pid(1.1, 0.9, 0.3, 0.2);
                law.velocity = velocity;
                law.computation_delay = i % 3 == 0 ? 0 : i % 3 * 0.095;
                if (i % 2 == 0) law.integral = IntegralRule::trapezoidal;
                if (i % 4 == 0) law.gains.filter = {};
                if (i % 4 == 0) law.derivative = DerivativeRule::difference;
                compare(kLags, kOwnLags, law, limits, in, 150);
            }
}

TEST(SampledResponse, IsThatOfThePlainLoopOnEveryKindOfPlant) {
    for (const KnownPlant& known : known_plants()) {
        if (known.name == "eighth order" || known.name == "fast lag") continue;  // the others are sufficient
        SCOPED_TRACE(known.name);
        const double Ts = 0.1, L = 0.0275;
        SampledPid law = pid(0.4, 0.1, 0.05, Ts);
        law.computation_delay = 0.0475;
        // Stable or not: fifty samples of any loop.
        compare(with_dead_time(known.plant, L), OwnPlant(known.num, known.den), law,
                {.output = ActuatorLimits{-0.3, 0.6}}, {1, 0.1}, 50);
    }
}

TEST(SampledResponse, OfAVelocityAlgorithmWithinLimitsIsThatOfThePosition) {
    const LinearPlant plant = *LinearPlant::make(kLags);
    for (int rule = 0; rule < 18; ++rule) {
        SampledPid law = pid(1.1, 0.9, 0.2, 0.15);
        law.integral = static_cast<IntegralRule>(rule % 3);
        law.derivative = static_cast<DerivativeRule>(rule / 3);
        law.slope_samples = 3;
        if (rule % 2 == 0) law.gains.filter = {static_cast<FilterType>(rule % 4), 0.2};
        const ProgramLimits wide{.output = ActuatorLimits{-50, 50}};
        const StepResponse position = simulate_sampled(plant, law, wide, {1, 0.5}, {.horizon = 20});
        law.velocity = true;
        const StepResponse velocity = simulate_sampled(plant, law, wide, {1, 0.5}, {.horizon = 20});
        ASSERT_EQ(position.nodes.size(), velocity.nodes.size()) << rule;
        for (std::size_t i = 0; i < position.nodes.size(); ++i) {
            EXPECT_NEAR(position.nodes[i].u, velocity.nodes[i].u, 1e-11);
            EXPECT_NEAR(position.nodes[i].y, velocity.nodes[i].y, 1e-11);
        }
    }
}

TEST(SampledResponse, NodesAscendAndTheOutputIsHeldBetweenThem) {
    const LinearPlant plant = *LinearPlant::make(kLags);
    for (const double delay : {0.0, 0.06, 0.3}) {
        SampledPid law = pid(0.5, 0.4, 0.1, 0.2);
        law.computation_delay = delay;
        const StepResponse response = simulate_sampled(plant, law, {}, {1, 0.5}, {.horizon = 7.3});
        const auto& nodes = response.nodes;
        EXPECT_EQ(nodes.front().t, 0);
        EXPECT_EQ(nodes.back().t, 7.3);  // between two samples
        // The command at the first sample: Kp b r + Ki Ts r + Kd c r/(Tf + Ts), from the end of the delay on.
        const double first = 0.5 * 0.8 + 0.4 * 0.2 + 0.1 * 0.3 / (0.17 + 0.2);
        EXPECT_NEAR(nodes.front().u, delay == 0 ? first : 0, 1e-14);
        for (const ResponseNode& node : nodes) {
            if (node.u == 0) continue;
            EXPECT_NEAR(node.t, delay, 1e-12);
            EXPECT_NEAR(node.u, first, 1e-14);
            break;
        }
        double integral = 0;
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const ResponseNode &a = nodes[i - 1], &b = nodes[i];
            EXPECT_GE(b.t, a.t);
            EXPECT_EQ(b.u_slope, 0);
            if (a.u != b.u) {
                const double periods = (b.t - delay) / 0.2;  // only at a sample and its delay
                EXPECT_EQ(a.t, b.t);
                EXPECT_NEAR(periods, std::round(periods), 1e-9);
            }
            const double h = b.t - a.t;  // Hermite's cubic
            integral += h - h * (0.5 * (a.y + b.y) + h / 12 * (a.y_slope - b.y_slope));
            EXPECT_NEAR(b.error_integral, integral, 1e-5);
        }
        const StepResponse to_rest = simulate_sampled(plant, law, {}, {1, 0.5}, {});
        EXPECT_TRUE(to_rest.settles);
        EXPECT_NEAR(to_rest.u_final, 0, 1e-12);  // 1/K less the load
        EXPECT_NEAR(to_rest.nodes.back().u, 0, 1e-6);
        EXPECT_NEAR(to_rest.nodes.back().y, 1, 1e-6);
        EXPECT_NEAR(*to_rest.error_integral_final, to_rest.nodes.back().error_integral, 1e-12);
    }
}

TEST(SampledResponse, NeverLeavesItsLimitsWhateverTheResolution) {
    const LinearPlant plant = *LinearPlant::make(kLags);
    for (const double resolution : {0.0, 0.07, 0.3, 0.45}) {
        const ProgramLimits limits{.output = ActuatorLimits{-0.35, 0.8}, .u_resolution = resolution};
        const StepResponse response = simulate_sampled(plant, pid(2, 1.5, 0, 0.2), limits, {1, 0}, {.horizon = 10});
        double highest = 0;
        for (const ResponseNode& node : response.nodes) {
            ASSERT_LE(node.u, 0.8 + 1e-12) << resolution;
            ASSERT_GE(node.u, -0.35 - 1e-12) << resolution;
            highest = std::max(highest, node.u);
        }
        EXPECT_NEAR(highest, resolution == 0 ? 0.8 : resolution * std::floor(0.8 / resolution), 1e-12);
    }
}

// A target beyond the limits: y settles at K times the limit, u at the limit itself, not a step of its integral short
// of it, and the run ends there.
TEST(SampledResponse, ComesToRestAtALimit) {
    const LinearPlant plant = *LinearPlant::make(kLags);
    const ProgramLimits limits{.output = ActuatorLimits{-0.3, 0.3}};
    for (const bool velocity : {false, true}) {
        SampledPid law = pid(1.1, 0.9, 0.2, 0.2);
        law.velocity = velocity;
        const StepResponse response = simulate_sampled(plant, law, limits, {1, 0}, {});
        EXPECT_TRUE(response.settles);
        EXPECT_FALSE(response.error_integral_final);
        EXPECT_NEAR(response.y_final, 0.6, 1e-12);
        EXPECT_LT(response.nodes.back().t, 200);
        EXPECT_NEAR(response.nodes.back().y, 0.6, 1e-6);
        EXPECT_EQ(response.nodes.back().u, 0.3);
    }
}

// Sixteen whole oscillations per period, undamped up to a millionth: y is at the same place at every sample and
// halfway. An integrator cannot settle at a limit: only the horizon or the growth ends the run.
TEST(SampledResponse, DoesNotRestWhereALimitLeavesAnIntegratorMoving) {
    const LinearPlant plant = *LinearPlant::make(Ipdt{.K = 1, .L = 0.2});
    const ProgramLimits limits{.output = ActuatorLimits{-0.3, 0.3}};
    SampledOptions options;
    options.max_samples = 3000;
    const StepResponse response = simulate_sampled(plant, pid(0.5, 0.1, 0, 0.2), limits, {0, 1}, options);
    EXPECT_FALSE(response.settles);
    EXPECT_NEAR(response.nodes.back().y_slope, 0.7, 1e-9);
}

// A run can be stopped at any moment.
TEST(SampledResponse, OneThatIsStoppedAtOnceHasItsBeginning) {
    const LinearPlant plant = *LinearPlant::make(kLags);
    std::stop_source stop;
    stop.request_stop();
    SampledOptions options;
    options.stop = stop.get_token();
    for (const StepInputs in : {StepInputs{1, 0}, StepInputs{0, 1}}) {
        const StepResponse response = simulate_sampled(plant, pid(0.9, 0.6, 0.2, 0.2), {}, in, options);
        EXPECT_FALSE(response.settles);
        EXPECT_FALSE(response.nodes.empty());
    }
}

// A run with a horizon is the run to infinity up to that time, wherever it lies between two samples.
TEST(SampledResponse, IndicesEndExactlyAtTheHorizon) {
    const LinearPlant plant = *LinearPlant::make(kLags);
    SampledPid law = pid(0.9, 0.6, 0.2, 0.2);
    law.computation_delay = 0.07;
    for (const StepInputs in : {StepInputs{1, 0}, StepInputs{0, 1}}) {
        const StepResponse whole = simulate_sampled(plant, law, {}, in, {});
        for (const double horizon : {0.05, 0.2, 0.31, 1.0, 3.333, 5.03, 6.0}) {
            const StepResponse cut = simulate_sampled(plant, law, {}, in, {.horizon = horizon});
            ASSERT_TRUE(cut.settles);
            EXPECT_EQ(cut.nodes.back().t, horizon);
            constexpr int kParts = 200000;
            const auto values = sampled(whole.nodes, horizon, kParts + 1);
            double IAE = 0;
            for (int i = 0; i < kParts; ++i)
                IAE +=
                    horizon / kParts * 0.5 *
                    (std::abs(in.r - values[std::size_t(i)].first) + std::abs(in.r - values[std::size_t(i) + 1].first));
            EXPECT_NEAR(integral_of_absolute_error(cut.nodes, in.r, std::nullopt), IAE, 1e-5 * IAE + 1e-12) << horizon;
        }
    }
}

TEST(SampledResponse, SeesWhatSwingsWholeTimesBetweenTheSamples) {
    const double Ts = 1, omega = 32 * std::numbers::pi, zeta = 1e-7;
    const LinearPlant plant = *LinearPlant::make(OscillatorySopdt{.K = 1, .T = 1 / omega, .zeta = zeta});
    const SampledPid law{.gains = {.Kp = 0.5, .Ki = 0}, .Ts = Ts};
    const StepResponse response = simulate_sampled(plant, law, {}, {1, 0}, {.horizon = 20});
    // u = 1/2 at once and forever, y = (1 - cos(omega t))/2: as far from 1 as from 0.
    EXPECT_NEAR(extremes_of_y(response.nodes).max, 1, 1e-3);
    EXPECT_NEAR(integral_of_absolute_error(response.nodes, 1, std::nullopt), 10, 0.05);
}

}  // namespace
}  // namespace tunewright
