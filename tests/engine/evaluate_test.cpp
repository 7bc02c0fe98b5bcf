// Evaluation compared with closed forms and with a simple simulation in tiny steps that shares no code with the
// engine's.
#include "engine/evaluation/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tunewright {
namespace {

Evaluation evaluated(const Plant& plant, const Controller& controller, EvaluateOptions options = {}) {
    auto evaluation = evaluate(plant, controller, options);
    EXPECT_TRUE(evaluation.has_value()) << (evaluation ? "" : evaluation.error().message);
    return *evaluation;
}

constexpr double kPromised = 5e-4;  // relative, of every integral

TEST(Evaluate, PiOnItsOwnLagIsAFirstOrderLoop) {
    // 1/(s + 1) with Kp = k, Ti = 1: y = 1 - e^(-kt), u = 1 + (k - 1) e^(-kt); after a load step y = (e^(-t) -
    // e^(-kt))/(k - 1).
    const double k = 4;
    const auto e = evaluated(Fopdt{.K = 1, .T = 1, .L = 0}, IdealPid{.Kp = k, .Ti = 1});
    const auto& s = e.performance.setpoint;
    EXPECT_NEAR(*s.IAE / (1 / k), 1, 1e-4);
    EXPECT_NEAR(*s.ISE / (1 / (2 * k)), 1, 1e-4);
    EXPECT_NEAR(*s.ITAE / (1 / (k * k)), 1, 1e-4);
    EXPECT_NEAR(*s.TV / (k + (k - 1)), 1, 1e-4);
    EXPECT_NEAR(*s.first_move, k, 1e-12);
    EXPECT_NEAR(*s.rise_time / (std::log(9) / k), 1, 1e-4);
    EXPECT_NEAR(*s.rise_time_5_95 / (std::log(19) / k), 1, 1e-4);
    EXPECT_NEAR(*s.settling_time / (std::log(50) / k), 1, 1e-4);
    EXPECT_NEAR(*s.overshoot_percent, 0, 1e-9);
    const auto& l = e.performance.load;
    EXPECT_NEAR(*l.IAE / (1 / k), 1, 1e-4);
    EXPECT_NEAR(*l.ITAE / ((1 - 1 / (k * k)) / (k - 1)), 1, 1e-4);
    EXPECT_NEAR(*l.ISE / ((0.5 + 0.5 / k - 2 / (1 + k)) / ((k - 1) * (k - 1))), 1, 1e-4);
    const double t_peak = std::log(k) / (k - 1);
    EXPECT_NEAR(*l.peak, (std::exp(-t_peak) - std::exp(-k * t_peak)) / (k - 1), 1e-5);
    EXPECT_NEAR(*e.robustness.Ms, 1, 1e-9);
    EXPECT_NEAR(*e.robustness.phase_margin_deg, 90, 1e-6);
}

TEST(Evaluate, ASetPointJumpsThroughAPlantsDirectTerm) {
    // (0.5 s + 1.5)/(s + 0.4) with Kp = 1, Ti = 1.1: y(0+) = 0.5/(1 + 0.5). The indices come from an independent
    // program (exact exponentials, Richardson's extrapolation over two step sizes), to 1e-7.
    EvaluateOptions options;
    options.points = 50;
    const auto e =
        evaluated(TransferFunction{.num = {0.5, 1.5}, .den = {1, 0.4}, .L = 0}, IdealPid{.Kp = 1, .Ti = 1.1}, options);
    const auto& s = e.performance.setpoint;
    EXPECT_NEAR(*s.IAE, 0.5407095, 1e-5);
    EXPECT_NEAR(*s.overshoot_percent, 4.862, 1e-3);
    EXPECT_NEAR(*s.TV, 1.07683, 1e-4);
    ASSERT_TRUE(e.responses);
    EXPECT_NEAR(e.responses->setpoint.y.front(), 1.0 / 3, 1e-9);
    EXPECT_NEAR(e.responses->setpoint.y.back(), 1, 0.01);
}

TEST(Evaluate, ADampedLoopOnAResonantPlantComesToRest) {
    // Steps longer than the dead time kept such runs moving at 1e-7 of their size. A simulation up to a horizon at
    // which the rest is below 1e-9 gives the reference of the indices.
    const Plant plant =
        Zpk{.K = 7, .zeros = {}, .poles = {{-0.03, 1}, {-0.03, -1}, {-0.05, 2.7}, {-0.05, -2.7}}, .L = 0.3};
    for (const double factor : {0.84, 0.9, 0.95, 1.0, 1.02, 1.05}) {
        const IdealPid pid{.Kp = 0.0527337 * factor,
                           .Ti = 0.578744,
                           .Td = 3.960216,
                           .filter = {FilterType::measurement_second_order, 0.3960216}};
        EvaluateOptions finite;
        finite.horizon = 300;
        const auto e = evaluated(plant, pid), reference = evaluated(plant, pid, finite);
        ASSERT_TRUE(e.performance.load.IAE) << factor << ": " << e.performance.load.IAE.why;
        EXPECT_NEAR(*e.performance.load.IAE / *reference.performance.load.IAE, 1, 2e-5) << factor;
        EXPECT_NEAR(*e.performance.load.TV / *reference.performance.load.TV, 1, 1e-3) << factor;
    }
}

TEST(Evaluate, WhatEndsBeforeItsHorizonHasNoIndices) {
    const double zeta = 1e-4, omega = 3;
    const std::complex<double> pole = omega * std::complex<double>(-zeta, std::sqrt(1 - zeta * zeta));
    EvaluateOptions options;
    options.horizon = 40'000;
    options.points = 0;
    const auto e = evaluated(Zpk{.K = 0.9, .zeros = {}, .poles = {pole, std::conj(pole), -0.1}, .L = 0.5},
                             ParallelPid{.Kp = 0.002, .Ki = 0.004}, options);
    EXPECT_FALSE(e.performance.load.IAE);
    EXPECT_FALSE(e.performance.load.TV);
    EXPECT_NE(e.performance.load.IAE.why.find("shorter"), std::string::npos) << e.performance.load.IAE.why;
}

TEST(Evaluate, ASeriesControllerIsItsOwnSeriesEquivalent) {
    // 1 + Td/Ti = 1.25, so b = 1 in the series form is 0.8 in the ideal one; the first move is Kp b of its own form.
    const SeriesPid given{.Kp = 1.5, .Ti = 8, .Td = 2};
    const auto e = evaluated(Fopdt{.K = 1, .T = 10, .L = 1}, given);
    EXPECT_NEAR(std::get<SeriesPid>(e.controller).b_equivalent, 0.8, 1e-15);
    const auto& series = e.equivalents.series;
    ASSERT_TRUE(series);
    EXPECT_EQ(series->Kp, 1.5);
    EXPECT_EQ(series->Ti, 8);
    EXPECT_EQ(series->Td, 2);
    EXPECT_EQ(series->b, 1);
    EXPECT_NEAR(series->b_equivalent, 0.8, 1e-15);
    EXPECT_NEAR(*e.performance.setpoint.first_move, 1.5, 1e-12);
}

/// Heun's rule with the delayed input from a table, for a FOPDT plant and every filter type.
struct PlainLoop {
    double K, T, L;
    IdealPid c;

    struct Result {
        double IAE = 0, ISE = 0, ITAE = 0, TV = 0, peak = 0;
    };
    struct State {
        double y = 0, I = 0, f1 = 0, f2 = 0;
    };

    double output(const State& x, double r) const {
        const double Tf = c.filter.Tf;
        double measured = x.y, derivative = 0;
        switch (c.filter.type) {
            case FilterType::none: break;
            case FilterType::derivative: derivative = ((c.c * r - x.y) - x.f1) / Tf; break;
            case FilterType::measurement_first_order:
                measured = x.f1;
                derivative = -(x.y - x.f1) / Tf;
                break;
            case FilterType::measurement_second_order:
                measured = x.f1;
                derivative = -x.f2;
                break;
        }
        return c.Kp * (c.b * r - measured + x.I / c.Ti + c.Td * derivative);
    }

    State slope(const State& x, double r, double v) const {
        const double Tf = c.filter.Tf;
        State d;
        d.y = (K * v - x.y) / T;
        double measured = x.y;
        switch (c.filter.type) {
            case FilterType::none: break;
            case FilterType::derivative: d.f1 = ((c.c * r - x.y) - x.f1) / Tf; break;
            case FilterType::measurement_first_order:
                d.f1 = (x.y - x.f1) / Tf;
                measured = x.f1;
                break;
            case FilterType::measurement_second_order:
                d.f1 = x.f2;
                d.f2 = (x.y - x.f1 - Tf * x.f2) * 2 / (Tf * Tf);
                measured = x.f1;
                break;
        }
        d.I = r - measured;
        return d;
    }

    Result run(double r, double load, double t_end, int per_dead_time) const {
        const double h = L / per_dead_time;
        const auto delay = static_cast<std::size_t>(per_dead_time);
        std::vector<double> w(1, 0.0);
        State x;
        Result result;
        double u = output(x, r), e = r - x.y;
        result.TV = std::abs(u);
        w[0] = u + load;
        const auto n = static_cast<std::size_t>(t_end / h);
        for (std::size_t i = 0; i < n; ++i) {
            const double v0 = i >= delay ? w[i - delay] : 0, v1 = i + 1 > delay ? w[i + 1 - delay] : 0;
            const State a = slope(x, r, v0);
            const State guess{x.y + h * a.y, x.I + h * a.I, x.f1 + h * a.f1, x.f2 + h * a.f2};
            const State b = slope(guess, r, v1);
            x = {x.y + h / 2 * (a.y + b.y), x.I + h / 2 * (a.I + b.I), x.f1 + h / 2 * (a.f1 + b.f1),
                 x.f2 + h / 2 * (a.f2 + b.f2)};
            const double next = r - x.y, t = (static_cast<double>(i) + 0.5) * h;
            result.IAE += h / 2 * (std::abs(e) + std::abs(next));
            result.ISE += h / 2 * (e * e + next * next);
            result.ITAE += h / 2 * t * (std::abs(e) + std::abs(next));
            e = next;
            const double now = output(x, r);
            result.TV += std::abs(now - u);
            u = now;
            w.push_back(u + load);
            if (std::abs(x.y) > std::abs(result.peak)) result.peak = x.y;
        }
        return result;
    }
};

TEST(Evaluate, EveryIndexAgreesWithAPlainSimulation) {
    const PlainLoop loops[] = {
        {2, 10, 3, {.Kp = 0.8, .Ti = 6, .Td = 1.2, .filter = {FilterType::measurement_second_order, 0.4}}},
        {2, 10, 3, {.Kp = 0.9, .Ti = 6, .Td = 1.2, .b = 0.6, .filter = {FilterType::measurement_first_order, 0.4}}},
        {2, 10, 3, {.Kp = 1.1, .Ti = 6, .Td = 0.8, .b = 1, .c = 0.5, .filter = {FilterType::derivative, 0.5}}},
        {1, 2, 4, {.Kp = 0.3, .Ti = 3}},
        {-1, -10, 1, {.Kp = 5, .Ti = 12, .Td = 0.3, .filter = {FilterType::measurement_second_order, 0.1}}},
    };
    for (const auto& loop : loops) {
        const auto e = evaluated(Fopdt{.K = loop.K, .T = loop.T, .L = loop.L}, loop.c);
        ASSERT_TRUE(e.robustness.stable);
        const auto s = loop.run(1, 0, 400, 3000), l = loop.run(0, 1, 400, 3000);
        EXPECT_NEAR(*e.performance.setpoint.IAE / s.IAE, 1, kPromised);
        EXPECT_NEAR(*e.performance.setpoint.ISE / s.ISE, 1, kPromised);
        EXPECT_NEAR(*e.performance.setpoint.ITAE / s.ITAE, 1, kPromised);
        EXPECT_NEAR(*e.performance.setpoint.TV / s.TV, 1, kPromised);
        EXPECT_NEAR(*e.performance.load.IAE / l.IAE, 1, kPromised);
        EXPECT_NEAR(*e.performance.load.ISE / l.ISE, 1, kPromised);
        EXPECT_NEAR(*e.performance.load.ITAE / l.ITAE, 1, kPromised);
        EXPECT_NEAR(*e.performance.load.TV / l.TV, 1, kPromised);
        EXPECT_NEAR(*e.performance.load.peak / l.peak, 1, kPromised);
        EXPECT_NEAR(*e.performance.setpoint.overshoot_percent, std::max(0.0, 100 * (s.peak - 1)), 0.1);
    }
}

TEST(Evaluate, IsStoppedBetweenItsParts) {
    std::stop_source source;
    source.request_stop();
    EvaluateOptions options;
    options.stop = source.get_token();
    const auto stopped = evaluate(Plant(Fopdt{.K = 1, .T = 1, .L = 0.2}), IdealPid{.Kp = 1, .Ti = 1}, options);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::cancelled);
}

TEST(Evaluate, MarginsObeyTheBoundsOfMs) {
    for (const double Kp : {0.3, 0.6, 0.9, 1.2}) {
        const auto e = evaluated(Sopdt{.K = 2, .T1 = 10, .T2 = 2, .L = 3}, IdealPid{.Kp = Kp, .Ti = 10});
        const double Ms = *e.robustness.Ms;
        EXPECT_GE(*e.robustness.gain_margin, Ms / (Ms - 1) * (1 - 1e-9));
        EXPECT_GE(*e.robustness.phase_margin_deg, 2 * std::asin(1 / (2 * Ms)) * 180 / std::numbers::pi * (1 - 1e-9));
    }
}

TEST(Evaluate, NoGainMarginIsInventedWherePhaseNeverReachesMinus180) {
    const auto e = evaluated(Sopdt{.K = 0.695, .T1 = 141, .T2 = 19.7, .L = 0},
                             IdealPid{.Kp = 2, .Ti = 160, .Td = 17, .filter = {FilterType::derivative, 1.8}});
    EXPECT_FALSE(e.robustness.gain_margin.has_value());
    EXPECT_FALSE(e.robustness.gain_margin.why.empty());
}

TEST(Evaluate, WithoutIntegralActionTheErrorStaysAndSaysSo) {
    const auto e = evaluated(Fopdt{.K = 2, .T = 5, .L = 1}, IdealPid{.Kp = 1});
    EXPECT_FALSE(e.performance.load.IAE.has_value());
    EXPECT_FALSE(e.performance.load.IAE.why.empty());
    EXPECT_NEAR(e.responses->load.y.back(), 2.0 / 3, 5e-3);
    EvaluateOptions finite;
    finite.horizon = 50;
    EXPECT_TRUE(evaluated(Fopdt{.K = 2, .T = 5, .L = 1}, IdealPid{.Kp = 1}, finite).performance.load.IAE.has_value());
}

TEST(Evaluate, AnUnstableLoopIsAnEntryWithReasons) {
    const auto e = evaluated(Fopdt{.K = 2, .T = 5, .L = 1}, IdealPid{.Kp = 20, .Ti = 1});
    EXPECT_FALSE(e.robustness.stable);
    EXPECT_FALSE(e.robustness.Ms.has_value());
    EXPECT_FALSE(e.performance.setpoint.IAE.has_value());
    EXPECT_FALSE(e.responses.has_value());
    ASSERT_FALSE(e.warnings.empty());
    EXPECT_EQ(e.warnings.front().code, "unstable-loop");
}

TEST(Evaluate, TinyDeadTimesCostNoMoreThanOthersAndTendToNone) {
    const IdealPid pid{.Kp = 3, .Ti = 1, .Td = 0.05, .filter = {FilterType::measurement_second_order, 0.02}};
    const auto none = evaluated(Fopdt{.K = 1, .T = 1, .L = 0}, pid),
               tiny = evaluated(Fopdt{.K = 1, .T = 1, .L = 1e-7}, pid);
    EXPECT_NEAR(*tiny.performance.load.IAE / *none.performance.load.IAE, 1, 1e-4);
    EXPECT_NEAR(*tiny.performance.setpoint.TV / *none.performance.setpoint.TV, 1, 1e-4);
}

TEST(Evaluate, LimitsAreKeptAndAnnounced) {
    EvaluateOptions options;
    options.actuator = ActuatorLimits{-0.2, 1.1};
    const auto e = evaluated(Fopdt{.K = 1, .T = 10, .L = 1}, IdealPid{.Kp = 5, .Ti = 8}, options);
    for (const double u : e.responses->setpoint.u) {
        EXPECT_LE(u, 1.1 + 1e-9);
        EXPECT_GE(u, -0.2 - 1e-9);
    }
    ASSERT_FALSE(e.warnings.empty());
    EXPECT_EQ(e.warnings.front().code, "actuator-limited");
    EXPECT_NEAR(e.responses->setpoint.y.back(), 1, 0.02);
}

TEST(Evaluate, OptionsOutOfRangeNameTheirField) {
    EvaluateOptions options;
    options.setpoint_step = 0;
    auto refused = evaluate(Fopdt{.K = 1, .T = 1, .L = 1}, IdealPid{.Kp = 1}, options);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().where, "evaluate/setpoint_step");
    options = {};
    options.points = 1;
    refused = evaluate(Fopdt{.K = 1, .T = 1, .L = 1}, IdealPid{.Kp = 1}, options);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().where, "evaluate/points");
}

}  // namespace
}  // namespace tunewright
