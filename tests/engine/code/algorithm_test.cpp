#include "engine/code/algorithm.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/code/settings.h"
#include "tests/engine/code/reference.h"

namespace tunewright::code {
namespace {

constexpr IntegralRule kIntegrals[] = {IntegralRule::backward, IntegralRule::forward, IntegralRule::trapezoidal};
constexpr DerivativeRule kDerivatives[] = {DerivativeRule::difference,
                                           DerivativeRule::filtered_backward,
                                           DerivativeRule::filtered_forward,
                                           DerivativeRule::filtered_trapezoidal,
                                           DerivativeRule::slope,
                                           DerivativeRule::four_points};
constexpr FilterType kFilters[] = {FilterType::none, FilterType::derivative, FilterType::measurement_first_order,
                                   FilterType::measurement_second_order};

SampledPid pid_of(FilterType filter, double sign = 1) {
    SampledPid pid{.gains = {.Kp = 1.7 * sign, .Ki = 0.21 * sign, .Kd = 2.3 * sign, .b = 0.6, .c = 0.3}, .Ts = 0.5};
    pid.gains.filter = {filter, filter == FilterType::none ? 0 : 0.9};
    pid.slope_samples = 4;
    return pid;
}

Program program_of(const SampledPid& pid, const CodeOptions& options = {}) {
    auto program = pid_algorithm(pid, options);
    EXPECT_TRUE(program) << (program ? "" : program.error().message);
    return program ? *program : Program{};
}

/// Calls `check` for each combination of filter, rules and form.
template <class Check>
void for_every_law(const Check& check) {
    for (const FilterType filter : kFilters) {
        for (const IntegralRule integral : kIntegrals) {
            for (const DerivativeRule derivative : kDerivatives) {
                for (const bool velocity : {false, true}) {
                    SampledPid pid = pid_of(filter);
                    pid.integral = integral;
                    pid.derivative = derivative;
                    pid.velocity = velocity;
                    if (integral == IntegralRule::trapezoidal) pid.gains.setpoint_lag = 1.5;
                    SCOPED_TRACE(testing::Message() << "filter " << int(filter) << " integral " << int(integral)
                                                    << " derivative " << int(derivative) << " velocity " << velocity);
                    check(pid);
                }
            }
        }
    }
}

// The law of sampled_pid.h, with I and D as defined there, everything 0 before k = 0.
class Law {
public:
    explicit Law(const SampledPid& pid) : pid_(pid) {}

    double step(double r, double y) {
        const auto& g = pid_.gains;
        const double Ts = pid_.Ts, Tf = g.filter.Tf;
        r_f_ = (g.setpoint_lag * r_f_ + Ts * r) / (g.setpoint_lag + Ts);
        r = r_f_;
        if (g.filter.type == FilterType::measurement_first_order) {
            yf_ = (Tf * yf_ + Ts * y) / (Tf + Ts);
        } else if (g.filter.type == FilterType::measurement_second_order) {
            v_ = (v_ + (2 * Ts / (Tf * Tf)) * (y - yf_)) / (1 + 2 * Ts / Tf + 2 * (Ts / Tf) * (Ts / Tf));
            yf_ += Ts * v_;
        } else {
            yf_ = y;
        }
        const double e = r - yf_;
        I_ += g.Ki * Ts *
              (pid_.integral == IntegralRule::backward  ? e
               : pid_.integral == IntegralRule::forward ? e_
                                                        : (e + e_) / 2);
        e_ = e;
        f_.push_back(g.c * r - yf_);
        D_ = derivative(f_.size() - 1);
        return g.Kp * (g.b * r - yf_) + I_ + D_;
    }

private:
    double f(std::size_t k, std::size_t ago) const { return k >= ago ? f_[k - ago] : 0; }
    double derivative(std::size_t k) const {
        const double Kd = pid_.gains.Kd, Ts = pid_.Ts, Tf = pid_.gains.filter.Tf, step = f(k, 0) - f(k, 1);
        const bool filtered = pid_.gains.filter.type == FilterType::derivative;
        const auto M = static_cast<std::size_t>(pid_.slope_samples);
        switch (pid_.derivative) {
            case DerivativeRule::slope: return Kd * (f(k, 0) - f(k, M)) / (static_cast<double>(M) * Ts);
            case DerivativeRule::four_points: return Kd * (3 * f(k, 0) + f(k, 1) - f(k, 2) - 3 * f(k, 3)) / (10 * Ts);
            case DerivativeRule::filtered_backward:
                if (filtered) return (Tf * D_ + Kd * step) / (Tf + Ts);
                break;
            case DerivativeRule::filtered_forward:
                if (filtered) return (1 - Ts / Tf) * D_ + Kd * step / Tf;
                break;
            case DerivativeRule::filtered_trapezoidal:
                if (filtered) return ((2 * Tf - Ts) * D_ + 2 * Kd * step) / (2 * Tf + Ts);
                break;
            case DerivativeRule::difference: break;
        }
        return Kd * step / Ts;
    }

    SampledPid pid_;
    double r_f_ = 0;
    double yf_ = 0, v_ = 0, I_ = 0, D_ = 0, e_ = 0;
    std::vector<double> f_;
};

// Only rounding: sums of some hundred terms of size 10.
TEST(PidAlgorithm, FromRestInAutomaticUIsTheSampledLaw) {
    for_every_law([](const SampledPid& pid) {
        const Program program = program_of(pid);
        Machine machine(program);
        machine["at_rest"] = 1;
        Law law(pid);
        std::mt19937 random(1);
        std::normal_distribution<double> noise;
        double largest = 0;
        for (int k = 0; k < 500; ++k) {
            const double r = k < 20 ? 1 : -0.5, y = 0.01 * k + noise(random);
            largest = std::max(largest, std::abs(machine.step(r, y) - law.step(r, y)));
        }
        EXPECT_LT(largest, 2e-12);
    });
}

TEST(PidAlgorithm, AnOperatingPointMovesTheLawAsItStands) {
    for_every_law([](const SampledPid& pid) {
        const Program program = program_of(pid, {.bias = 40, .y0 = 70});
        Machine machine(program);
        machine["at_rest"] = 1;
        Law law(pid);
        std::mt19937 random(2);
        std::normal_distribution<double> noise;
        for (int k = 0; k < 100; ++k) {
            const double r = 1, y = noise(random);
            ASSERT_NEAR(machine.step(70 + r, 70 + y) - 40, law.step(r, y), 1e-10);
        }
    });
}

struct Scenario {
    CodeOptions options;
    bool at_rest = false;
    double sign = 1;
};

// Limits, noise, manual phases and new settings, compared with the controller written from its description.
void compare(SampledPid pid, const Scenario& scenario) {
    const Program program = program_of(pid, scenario.options);
    Machine machine(program);
    machine["at_rest"] = scenario.at_rest ? 1 : 0;
    const bool tracks = machine.has("Tt");
    Reference reference(pid, scenario.options, scenario.at_rest, tracks ? machine["Tt"] : 1);
    const bool direct = machine["direct"] != 0;
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    double plant = 50, u = scenario.options.bias;
    Gains now{pid.gains.Kp, pid.gains.Ki, pid.gains.Kd, pid.gains.b};
    for (int k = 0; k < 1500; ++k) {
        if (k % 100 == 50) {
            // One setting at a time, so that each change counts by itself.
            const int turn = k / 100 % 4;
            if (turn == 0) machine["Kp"] = 1 + 0.001 * k;
            if (turn == 1 && machine.has("Ti")) machine["Ti"] = 9.0 - 0.003 * k;
            if (turn == 2 && machine.has("Td")) machine["Td"] = 0.5 + 0.001 * k;
            if (turn == 3) machine["b"] = 0.3 + 0.0004 * k;
            const double Kp = machine["Kp"] * (direct ? -1 : 1);
            now = {Kp, machine.has("Ti") ? Kp / machine["Ti"] : 0, machine.has("Td") ? Kp * machine["Td"] : 0,
                   machine["b"]};
        }
        const double r = (k / 300) % 2 ? 62 : 45, y = plant + 0.2 * noise(random);
        const bool manual = (k / 250) % 5 == 3 || (k < 7 && !scenario.at_rest);
        u = machine.step(r, y, manual, 20 + 0.05 * k);
        ASSERT_NEAR(u, reference.step(r, y, manual, 20 + 0.05 * k, now), 1e-9) << "call " << k;
        plant += 0.05 * ((direct ? 60 - u : u) + 10 - plant);
    }
}

TEST(PidAlgorithm, LimitsManualAndNewSettingsActAsDescribed) {
    for_every_law([](const SampledPid& pid) {
        for (const AntiWindup anti_windup : {AntiWindup::back_calculation, AntiWindup::clamping}) {
            SCOPED_TRACE(testing::Message() << "anti-windup " << int(anti_windup));
            compare(pid, {{.anti_windup = anti_windup, .u_min = 5, .u_max = 75, .bias = 30}});
            compare(pid, {{.anti_windup = anti_windup, .u_min = 0, .u_max = 60, .rate_limit = 4, .bias = 30, .y0 = 50},
                          true});
        }
    });
}

TEST(PidAlgorithm, DirectActionTurnsEveryPartRound) {
    for (const bool velocity : {false, true}) {
        SampledPid pid = pid_of(FilterType::measurement_first_order, -1);
        pid.velocity = velocity;
        compare(pid, {{.u_min = 0, .u_max = 60, .bias = 30}});
    }
}

TEST(PidAlgorithm, ControllersWithFewerPartsActAsDescribed) {
    for (const AntiWindup anti_windup : {AntiWindup::back_calculation, AntiWindup::clamping}) {
        const Scenario scenario{{.anti_windup = anti_windup, .u_min = 0, .u_max = 60, .bias = 30, .y0 = 50}};
        SampledPid pid = pid_of(FilterType::none);
        pid.gains.Kd = 0;
        compare(pid, scenario);
        pid.gains.Ki = 0;
        compare(pid, scenario);
        pid = pid_of(FilterType::derivative);
        pid.gains.Ki = 0;
        compare(pid, scenario);
    }
}

TEST(PidAlgorithm, TheNonlinearPidFeedsItsIntegralWithTheScaledError) {
    for (const IntegralRule integral : kIntegrals) {
        for (const bool velocity : {false, true}) {
            SampledPid pid = pid_of(FilterType::derivative);
            pid.integral = integral;
            pid.velocity = velocity;
            compare(pid, {{.u_min = 0, .u_max = 60, .bias = 30, .delta_r = 2.5}});
        }
    }
}

TEST(PidAlgorithm, PureIntegralActionIsSetByItsOwnGain) {
    SampledPid pid{.gains = {.Kp = 0, .Ki = -0.2}, .Ts = 0.5};
    const Program program = program_of(pid);
    Machine machine(program);
    EXPECT_EQ(machine["Ki"], 0.2);
    EXPECT_EQ(machine["direct"], 1);
    EXPECT_FALSE(machine.has("Ti"));
    EXPECT_EQ(machine["Tt"], 0.5);
    machine["at_rest"] = 1;
    EXPECT_DOUBLE_EQ(machine.step(1, 0), -0.1);
    EXPECT_DOUBLE_EQ(machine.step(1, 0), -0.2);
}

TEST(PidAlgorithm, TheFirstCallDoesNotKick) {
    for_every_law([](const SampledPid& pid) {
        const Program program = program_of(pid, {.bias = 12});
        Machine machine(program);
        EXPECT_DOUBLE_EQ(machine.step(80, 20), 12);
        // Then only the integral moves u: by Ki Ts e.
        EXPECT_NEAR(machine.step(80, 20), 12 + 0.21 * 0.5 * 60, 1e-9);
    });
}

// u must not jump by more than the share of the integral if only the mode or a setting has changed.
TEST(PidAlgorithm, NeitherTheSwitchToAutomaticNorNewSettingsJump) {
    for_every_law([](const SampledPid& pid) {
        const Program program = program_of(pid);
        Machine machine(program);
        for (int k = 0; k < 20; ++k) machine.step(50, 30, true, 44);
        EXPECT_NEAR(machine.step(50, 30), 44 + 0.21 * 0.5 * 20, 1e-9);
        for (int k = 0; k < 80; ++k) machine.step(30, 30);
        double u = machine.step(30, 30);
        machine["Kp"] = 17;
        machine["Td"] = 9;
        machine["b"] = 0;
        EXPECT_NEAR(machine.step(30, 30), u, 1e-5);  // remainder of the old set point in the filters
        u = machine.step(30, 30);
        machine["Ti"] = 1;
        EXPECT_NEAR(machine.step(30, 30), u, 1e-5);
    });
}

// u must later contain nothing that the operator's u does not: from a false measurement in the last manual call, the
// proportional part and one share of the integral stay, and nothing of the derivative.
TEST(PidAlgorithm, TheSwitchToAutomaticKeepsNothingOfTheDerivativesNoise) {
    constexpr double kFalse = 3;
    for_every_law([](const SampledPid& law) {
        for (const double Ki : {law.gains.Ki, 0.0}) {
            SampledPid pid = law;
            pid.gains.Ki = Ki;
            if (Ki == 0 && pid.velocity) continue;
            const Program program = program_of(pid);
            const auto later = [&](double error) {
                Machine machine(program);
                for (int k = 0; k < 20; ++k) machine.step(50, 50, true, 44);
                machine.step(50, 50 + error, true, 44);
                for (int k = 0; k < 400; ++k) machine.step(50, 50);
                return machine.step(50, 50);
            };
            const double max = kFalse * (pid.gains.Kp + Ki * pid.Ts);
            EXPECT_LE(std::abs(later(kFalse) - later(0)), max * (1 + 1e-9)) << "Ki " << Ki;
        }
    });
}

// Half an hour at a limit: without anti-windup the integral would need the same time to return.
TEST(PidAlgorithm, ULeavesItsLimitAsSoonAsTheErrorHasTurned) {
    for (const AntiWindup anti_windup : {AntiWindup::back_calculation, AntiWindup::clamping}) {
        const Program program = program_of(pid_of(FilterType::none), {.anti_windup = anti_windup, .u_max = 10});
        Machine machine(program);
        machine["at_rest"] = 1;
        for (int k = 0; k < 3600; ++k) machine.step(10, 0);
        EXPECT_EQ(machine.step(10, 0), 10);
        int calls = 0;
        while (machine.step(10, 12) >= 10 && calls < 1000) ++calls;
        EXPECT_LT(calls, 3);
    }
}

TEST(PidAlgorithm, TheRateOfUIsLimitedInAutomatic) {
    const Program program = program_of(pid_of(FilterType::none), {.rate_limit = 2});
    Machine machine(program);
    machine["at_rest"] = 1;
    for (int k = 1; k <= 5; ++k) EXPECT_DOUBLE_EQ(machine.step(100, 0), k);
    EXPECT_DOUBLE_EQ(machine.step(100, 0, true, 50), 50);
    EXPECT_DOUBLE_EQ(machine.step(100, 0), 51);
}

TEST(PidAlgorithm, ARestartIsAFirstCallAgain) {
    SampledPid pid = pid_of(FilterType::none);
    pid.gains.Kd = 0;
    const Program program = program_of(pid, {.bias = 12});
    Machine machine(program);
    for (int k = 0; k < 50; ++k) machine.step(80, k % 7);
    machine["restart"] = 1;
    EXPECT_DOUBLE_EQ(machine.step(30, 20), 12);
    EXPECT_DOUBLE_EQ(machine.step(10, 25), 12);
    machine["restart"] = 0;
    EXPECT_NEAR(machine.step(25, 25), 12 + 1.7 * 0.6 * 15, 1e-9);
}

TEST(PidAlgorithm, WhatCannotWorkIsRefusedWithASentence) {
    const auto fault = [](const SampledPid& pid, const CodeOptions& options = {}) {
        const auto program = pid_algorithm(pid, options);
        return program ? std::string("none") : program.error().where + ": " + program.error().message;
    };
    SampledPid pid = pid_of(FilterType::derivative);
    pid.Ts = 0;
    EXPECT_EQ(fault(pid), "sample_time: sample_time is 0 s; it must be above 0.");
    pid.Ts = 2;
    pid.derivative = DerivativeRule::filtered_forward;
    EXPECT_NE(fault(pid).find("stable only for Tf above half the sample time; Tf is 0.9 s and the sample time 2 s"),
              std::string::npos);
    pid.derivative = DerivativeRule::slope;
    pid.slope_samples = 0;
    EXPECT_EQ(fault(pid), "slope_samples: slope_samples is 0; it must be 1 to 1000.");
    pid = pid_of(FilterType::none);
    EXPECT_EQ(fault(pid, {.u_min = 3, .u_max = 3}), "u_max: u_max is 3 and u_min 3; u_max must be > u_min.");
    EXPECT_EQ(fault(pid, {.rate_limit = -1}), "rate_limit: rate_limit is -1; it must be >= 0.");
    pid.gains.Ki = 0;
    pid.velocity = true;
    EXPECT_NE(fault(pid).find("u would not return to its level. Choose position."), std::string::npos);
}

}  // namespace
}  // namespace tunewright::code
