// The programs of structures against the same laws written plainly, with limits, manual and changes of mode.
#include "engine/structure/program/loop_programs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "engine/code/interpreter.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

using code::Interpreter;

constexpr double kTs = 0.5;

SampledPid sampled(double Kp, double Ti) { return {.gains = to_parallel(pi(Kp, Ti)), .Ts = kTs}; }

/// A PI by the backward rule with back-calculation, Tt = Ti, and any limits in each call.
struct PlainPi {
    double Kp, Ti, I = 0, u = 0;
    bool started = false;

    double automatic(double r, double y, double low, double high, double start) {
        if (!started) return given(r, y, std::clamp(start, low, high));
        I += Kp / Ti * kTs * (r - y);
        const double raw = Kp * (r - y) + I;
        u = std::clamp(raw, low, high);
        I += kTs / Ti * (u - raw);
        return u;
    }
    double given(double r, double y, double value) {
        started = true;
        I = value - Kp * (r - y);
        return u = value;
    }
};

class Signals {
public:
    double noise(double size) { return size * normal_(engine_); }

private:
    std::mt19937 engine_{5};
    std::normal_distribution<> normal_;
};

TEST(CascadeProgram, ItIsTwoControllersWithExternalResetWrittenPlainly) {
    const auto program = cascade_program(sampled(0.8, 3), sampled(1.1, 12), {.u_min = 0, .u_max = 60, .bias = 30},
                                         {.u_min = 0, .u_max = 80, .bias = 30, .y0 = 50});
    ASSERT_TRUE(program) << program.error().message;
    Interpreter machine(*program);
    PlainPi inner{.Kp = 0.8, .Ti = 3}, outer{.Kp = 1.1, .Ti = 12};
    Signals signals;
    double y1 = 50, y2 = 30, held = 0;
    for (int k = 0; k < 2000; ++k) {
        const double r1 = k / 250 % 2 == 0 ? 50 : 75, a = y1 + signals.noise(0.2), b = y2 + signals.noise(0.1);
        const bool manual = k / 100 % 7 == 3, on = k / 130 % 5 != 2;
        const double r2_of_operator = 20 + 0.01 * k, u_of_operator = 25 + 0.02 * k;
        machine["setpoint"] = r1;
        machine["measurement"] = a;
        machine["inner_measurement"] = b;
        machine["cascade_on"] = on ? 1 : 0;
        machine["inner_setpoint"] = r2_of_operator;
        machine["manual"] = manual ? 1 : 0;
        machine["manual_output"] = u_of_operator;
        machine.call();

        const double r2 = manual ? outer.given(r1, a, std::clamp(b, 0.0, 80.0))
                          : !on  ? outer.given(r1, a, std::clamp(r2_of_operator, 0.0, 80.0))
                                 : outer.automatic(r1, a, 0, 80, b);
        const double u =
            manual ? inner.given(r2, b, std::clamp(u_of_operator, 0.0, 60.0)) : inner.automatic(r2, b, 0, 60, 30);
        const bool limited = !manual && on && ((u >= 60 && r2 > b) || (u <= 0 && r2 < b));
        if (limited) outer.I += kTs / (12 + kTs) * (b - r2);
        held += limited ? 1 : 0;
        ASSERT_NEAR(machine["r2"], r2, 1e-9) << k;
        ASSERT_NEAR(machine["u"], u, 1e-9) << k;
        y2 += kTs / 4 * (u - y2);
        y1 += kTs / 20 * (y2 + 20 - y1);
    }
    EXPECT_GT(held, 50);  // the limit is reached and left
    EXPECT_LT(held, 1900);
}

/// A cascade whose valve saturates for long, then has a lower set point; `gain` of its inner plant: the largest |y1 -
/// r1| after y1 has reached it, and the largest outer integral part.
struct AfterSaturation {
    double overshoot = 0, integral = 0;
};
AfterSaturation after_saturation(bool external_reset, double gain = 1) {
    const auto program = cascade_program(sampled(2 * gain, 3), sampled(2, 20),
                                         {.u_min = std::min(0.0, 10 * gain), .u_max = std::max(0.0, 10 * gain)},
                                         {.u_min = -500, .u_max = 500});
    Interpreter machine(*program);
    machine["at_rest"] = 1;
    if (!external_reset) machine["reset_time"] = 1e12;
    AfterSaturation out;
    double y1 = 0, y2 = 0;
    bool reached = false;
    for (int k = 0; k < 4000; ++k) {
        const double r1 = k < 2000 ? 15 : 6;  // 15 cannot be reached
        machine["setpoint"] = r1;
        machine["measurement"] = y1;
        machine["inner_measurement"] = y2;
        machine.call();
        y2 += kTs / 4 * (gain * machine["u"] - y2);
        y1 += kTs / 30 * (y2 - y1);
        out.integral = std::max(out.integral, std::abs(machine["outer_integral"]));
        if (k < 2000) continue;
        reached = reached || y1 < 6;
        if (reached) out.overshoot = std::max(out.overshoot, std::abs(y1 - 6));
        if (k > 2000 + 400 && !reached) out.overshoot = 15;
    }
    return out;
}

TEST(CascadeProgram, ExternalResetKeepsTheOuterIntegralFromWindingUp) {
    const AfterSaturation with = after_saturation(true), without = after_saturation(false);
    EXPECT_LT(with.integral, 30);  // y2 reaches 10, Kp e is 10
    EXPECT_GT(without.integral, 400);
    EXPECT_LT(with.overshoot, 0.2 * without.overshoot);
    // The same with an inner loop of direct action, which saturates at its lower limit.
    EXPECT_NEAR(after_saturation(true, -1).integral, with.integral, 1e-9);
    EXPECT_NEAR(after_saturation(true, -1).overshoot, with.overshoot, 1e-9);
}

TEST(CascadeProgram, ChangesOfModeDoNotMoveTheValve) {
    const auto program = cascade_program(sampled(0.8, 3), sampled(1.1, 12), {.bias = 30}, {.bias = 30});
    Interpreter machine(*program);
    const auto call = [&](bool on, bool manual, double y2) {
        machine["setpoint"] = 50;
        machine["measurement"] = 44;
        machine["inner_measurement"] = y2;
        machine["cascade_on"] = on;
        machine["inner_setpoint"] = y2 + 1;
        machine["manual"] = manual;
        machine["manual_output"] = 37;
        machine.call();
        return machine["u"];
    };
    // Only the shares of the integrals of one call: Kp Ts e/Ti of the outer controller, and what the inner one makes of
    // it.
    constexpr double kOuter = 1.1 / 12 * kTs * 6, kInner = 0.8 * kOuter + 0.8 / 3 * kTs * (kOuter + 1);
    for (int k = 0; k < 5; ++k) call(true, true, 30);
    EXPECT_NEAR(call(true, false, 30), 37, kInner);
    for (int k = 0; k < 5; ++k) call(false, false, 30);
    const double before = machine["u"];
    EXPECT_NEAR(call(true, false, 30), before, kInner * (1 + 1e-9));
}

TEST(FeedforwardProgram, ItIsTheCompensatorAndTheControllerWrittenPlainly) {
    // Lf = 2.6 calls; Kf (Tz s + 1)/(Tp s + 1) by backward Euler.
    const Feedforward part{.Kf = 0.7, .Tz = 4, .Tp = 1.5, .Lf = 1.3};
    const auto program =
        feedforward_program(sampled(1.2, 6), part, {.u_min = 15, .u_max = 34, .rate_limit = 8, .bias = 30}, 5);
    ASSERT_TRUE(program) << program.error().message;
    Interpreter machine(*program);
    PlainPi feedback{.Kp = 1.2, .Ti = 6};
    Signals signals;
    std::vector<double> lead;
    double y = 20, lag = 0, u = 30;
    int held = 0;
    for (int k = 0; k < 2000; ++k) {
        const double d = 5 + (k / 90 % 2) * 20 + signals.noise(0.1), measured = y + signals.noise(0.1);
        const bool manual = k / 150 % 6 == 4;
        if (k == 0) {
            lag = d - 5;
            lead.assign(4, 0.7 * lag);
        }
        const double lag_before = lag;
        lag = (1.5 * lag + kTs * (d - 5)) / (1.5 + kTs);
        lead.push_back(0.7 * (lag + 4 * (lag - lag_before) / kTs));
        const std::size_t n = lead.size() - 1;
        const double added = -(0.4 * lead[n - 2] + 0.6 * lead[n - 3]);
        machine["setpoint"] = 24;
        machine["measurement"] = measured;
        machine["disturbance"] = d;
        machine["manual"] = manual ? 1 : 0;
        machine["manual_output"] = 22;
        machine.call();
        if (manual || k == 0) {
            u = manual ? 22 : 30;
            feedback.given(24, measured, u - added);
        } else {
            const double low = std::clamp(u - 8 * kTs, 15.0, 34.0), high = std::clamp(u + 8 * kTs, 15.0, 34.0);
            u = feedback.automatic(24, measured, low - added, high - added, 0) + added;
        }
        held += u < 15 + 1e-9 || u > 34 - 1e-9 ? 1 : 0;
        ASSERT_NEAR(machine["u"], u, 1e-9) << k;
        ASSERT_GE(machine["u"], 15);
        ASSERT_LE(machine["u"], 34);
        y += kTs / 10 * (u + 0.5 * d - 15 - y);
    }
    EXPECT_GT(held, 20);
    EXPECT_LT(held, 1900);
}

TEST(LevelProgram, TheGapIsASlopeWithoutSteps) {
    const auto program = level_program({.gains = {.Kp = -2}, .Ts = kTs}, {.bias = 40, .y0 = 50}, 3, 0.25);
    ASSERT_TRUE(program) << program.error().message;
    Interpreter machine(*program);
    machine["at_rest"] = 1;
    for (const auto& [y, u] :
         std::vector<std::pair<double, double>>{{50, 40}, {52, 41}, {53, 41.5}, {54, 43.5}, {47, 38.5}, {45, 34.5}}) {
        machine["setpoint"] = 50;
        machine["measurement"] = y;
        machine.call();
        EXPECT_NEAR(machine["u"], u, 1e-12) << y;
    }
}

TEST(InteractionProgram, DecouplingUsesTheOutputsThatLimitsAndManualHaveLeft) {
    Decoupling elements(2, std::vector<std::optional<Feedforward>>(2));
    elements[0][1] = Feedforward{.Kf = 0.6, .Tz = 0, .Tp = 2, .Lf = 1.0};  // a call of its own, and one that u is old
    elements[1][0] = Feedforward{.Kf = -0.3};
    const auto program =
        interaction_program({sampled(0.9, 5), sampled(0.7, 9)},
                            {{.u_min = 0, .u_max = 50, .bias = 20}, {.u_min = 0, .u_max = 70, .bias = 30}}, elements);
    ASSERT_TRUE(program) << program.error().message;
    Interpreter machine(*program);
    PlainPi one{.Kp = 0.9, .Ti = 5}, two{.Kp = 0.7, .Ti = 9};
    Signals signals;
    double y1 = 10, y2 = 12, u1 = 20, u2 = 30, lag = 0, late = 0;
    for (int k = 0; k < 2000; ++k) {
        const double r1 = 10 + 25 * (k / 200 % 2), r2 = 14, a = y1 + signals.noise(0.1), b = y2 + signals.noise(0.1);
        const bool manual = k / 170 % 4 == 2;
        lag = (2 * lag + kTs * (u2 - 30)) / (2 + kTs);
        const double to_one = late, to_two = -0.3 * (u1 - 20);
        late = 0.6 * lag;
        machine["setpoint_1"] = r1;
        machine["measurement_1"] = a;
        machine["setpoint_2"] = r2;
        machine["measurement_2"] = b;
        machine["manual_1"] = 0;
        machine["manual_2"] = manual;
        machine["manual_output_2"] = 44;
        machine.call();
        u1 = one.automatic(r1, a, -to_one, 50 - to_one, 20 - to_one) + to_one;
        u2 = manual ? 44 : two.automatic(r2, b, -to_two, 70 - to_two, 30 - to_two) + to_two;
        if (manual) two.given(r2, b, 44 - to_two);
        ASSERT_NEAR(machine["u_1"], u1, 1e-9) << k;
        ASSERT_NEAR(machine["u_2"], u2, 1e-9) << k;
        y1 += kTs / 10 * (u1 - 0.6 * u2 - y1 + 8);
        y2 += kTs / 15 * (u2 + 0.3 * u1 - y2 - 20);
    }
}

TEST(LoopPrograms, WhatCannotBeWrittenIsRefusedAtItsPlace) {
    SampledPid velocity = sampled(1, 5), unsampled = sampled(1, 5);
    velocity.velocity = true;
    unsampled.Ts = 0;
    EXPECT_EQ(cascade_program(sampled(1, 5), velocity, {}, {}).error().kind, ErrorKind::unsupported);
    EXPECT_EQ(cascade_program(unsampled, sampled(1, 5), {}, {}).error().where, "inner/sample_time");
    EXPECT_EQ(cascade_program(sampled(1, 5), sampled(1, 5), {}, {.u_min = 3, .u_max = 2}).error().where, "outer/u_max");
    EXPECT_EQ(feedforward_program(sampled(1, 5), {.Kf = 1, .Lf = 1e6}, {}).error().where, "feedforward/Lf");
    EXPECT_EQ(feedforward_program(sampled(1, 5), {.Kf = 1, .Tp = -1}, {}).error().where, "feedforward");
    EXPECT_EQ(level_program(sampled(-1, 5), {}, -1).error().where, "gap");
    EXPECT_EQ(interaction_program({sampled(1, 5), sampled(1, 5)}, {{}, {.rate_limit = -1}}).error().where,
              "controllers/1/rate_limit");
}

}  // namespace
}  // namespace tunewright::structure
