// The relay simulator compared with closed forms, Tsypkin's locus and superposed step responses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/relay/relay.h"
#include "engine/simulation/relay/relay_sampled.h"

namespace tunewright {
namespace {

constexpr double kPi = std::numbers::pi;

RelaySettings relay(double u_plus, double u_minus, double hysteresis) {
    RelaySettings settings;
    settings.u_plus = u_plus;
    settings.u_minus = u_minus;
    settings.hysteresis = hysteresis;
    return settings;
}

RelayExperiment run(const Plant& plant, const RelaySettings& settings) {
    auto experiment = simulate_relay(plant, settings, {});
    if (!experiment) {
        ADD_FAILURE() << experiment.error().message;
        return {};
    }
    return std::move(*experiment);
}

// Steady cycle of K e^(-Ls)/(T s + 1), T of either sign: y follows exponentials toward K u_plus and K u_minus.
struct FirstOrderCycle {
    double t_plus, t_minus, y_max, y_min;
};
FirstOrderCycle first_order(const Fopdt& p, const RelaySettings& s) {
    const double high = p.K * s.u_plus, low = p.K * s.u_minus, eps = s.hysteresis, decay = std::exp(-p.L / p.T);
    const double y_max = high + (eps - high) * decay, y_min = low + (-eps - low) * decay;
    return {p.L + p.T * std::log((high - y_min) / (high - eps)), p.L + p.T * std::log((y_max - low) / (-eps - low)),
            y_max, y_min};
}

TEST(Relay, FirstOrderCyclesAgreeWithTheirClosedForm) {
    for (const auto& [plant, settings] : {std::pair{Fopdt{1, 10, 2}, relay(1, -1, 0.2)},
                                          {Fopdt{1, 10, 2}, relay(1.3, -0.7, 0.2)},
                                          {Fopdt{3, 1, 20}, relay(1, -2, 0.5)},
                                          {Fopdt{1, 5, 0}, relay(1, -1, 0.1)},
                                          {Fopdt{1, 10, 2}, relay(1, -1, 0)},
                                          {Fopdt{1, 1e6, 1}, relay(1, -1, 0)},
                                          {Fopdt{-1, -1, 0.4}, relay(1, -1, 0)},
                                          {Fopdt{-1, -1, 0.69}, relay(1, -1, 0)},
                                          {Fopdt{-2, -3, 0.8}, relay(1.2, -1, 0.1)}}) {
        const FirstOrderCycle expected = first_order(plant, settings);
        const LimitCycle cycle = run(plant, settings).limit_cycle;
        ASSERT_TRUE(cycle.t_plus);
        EXPECT_NEAR(*cycle.t_plus, expected.t_plus, 1e-9 * expected.t_plus);
        EXPECT_NEAR(*cycle.t_minus, expected.t_minus, 1e-9 * expected.t_minus);
        EXPECT_NEAR(*cycle.y_max, expected.y_max, 1e-9 * expected.y_max);
        EXPECT_NEAR(*cycle.y_min, expected.y_min, -1e-9 * expected.y_min);
    }
}

TEST(Relay, IntegratingCyclesAgreeWithTheirClosedForm) {
    const double K = 0.5, L = 3;
    for (const RelaySettings& s : {relay(1, -1, 0.1), relay(1.3, -0.7, 0.1), relay(2, -1, 0)}) {
        const LimitCycle cycle = run(Ipdt{.K = K, .L = L}, s).limit_cycle;
        const double y_max = s.hysteresis + K * s.u_plus * L, y_min = -s.hysteresis + K * s.u_minus * L;
        EXPECT_NEAR(*cycle.t_plus, L + (s.hysteresis - y_min) / (K * s.u_plus), 1e-9 * L);
        EXPECT_NEAR(*cycle.t_minus, L + (y_max + s.hysteresis) / (-K * s.u_minus), 1e-9 * L);
        EXPECT_NEAR(*cycle.y_max, y_max, 1e-9);
        EXPECT_NEAR(*cycle.y_min, y_min, 1e-9);
    }
}

TEST(Relay, APureDeadTimeJumpsOverTheThresholds) {
    const LimitCycle cycle = run(Fopdt{.K = 2, .T = 0, .L = 3}, relay(1, -0.5, 0.2)).limit_cycle;
    EXPECT_NEAR(*cycle.t_plus, 3, 1e-12);
    EXPECT_NEAR(*cycle.t_minus, 3, 1e-12);
    EXPECT_EQ(*cycle.y_max, 2);
    EXPECT_EQ(*cycle.y_min, -1);
}

// y at the switch to u_plus of a symmetric cycle, as a Fourier series (Tsypkin 1984): an independent condition.
double y_at_switch(const LinearPlant& plant, double Pu, double d) {
    double sum = 0;
    for (int n = 40001; n >= 1; n -= 2) sum += plant.at({0, n * 2 * kPi / Pu}).imag() / n;
    return 4 * d / kPi * sum;
}

TEST(Relay, SymmetricCyclesLieOnTsypkinsLocus) {
    const std::vector<std::complex<double>> eight(8, -1.0);
    const std::pair<Plant, double> cases[] = {
        {Sopdt{.K = 1, .T1 = 20, .T2 = 2, .L = 1}, 0.2},
        {Zpk{.K = 1, .zeros = {}, .poles = eight, .L = 0}, 0.1},
        {TransferFunction{.num = {1}, .den = {1, 3, 3, 1}, .L = 0}, 0},
        {TransferFunction{.num = {-2, 1}, .den = {1, 3, 3, 1}, .L = 0.5}, 0.1},
        {Zpk{.K = 1e6, .zeros = {}, .poles = {-1.0, -1000.0, -1000.0}, .L = 0.1}, 0.1},
        {OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.1, .L = 0.5}, 1.3},
        {OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.01, .L = 20}, 0.1},  // six half periods of switches within the dead
                                                                         // time
        {Ipdt{.K = 1, .L = 0.5, .T = 2}, 0.05},
    };
    for (const auto& [plant, hysteresis] : cases) {
        const RelayExperiment experiment = run(plant, relay(1, -1, hysteresis));
        const LimitCycle& cycle = experiment.limit_cycle;
        ASSERT_TRUE(cycle.t_plus);
        EXPECT_NEAR(*cycle.t_plus, *cycle.t_minus, 1e-9 * cycle.Pu);
        EXPECT_NEAR(y_at_switch(*LinearPlant::make(plant), cycle.Pu, 1), -hysteresis, 1e-6 * *cycle.y_max);
    }
}

TEST(Relay, TheRecordEndsInTheSteadyCycle) {
    for (const Plant& plant : {Plant(Fopdt{1, 10, 2}), Plant(TransferFunction{{-1, 1}, {1, 5, 10, 10, 5, 1}, 1}),
                               Plant(Ipdt{0.5, 0.5, 3}), Plant(Fopdt{-1, -1, 0.4})}) {
        RelaySettings settings = relay(1.3, -0.7, 0.02);
        settings.cycles = 40;
        const RelayExperiment experiment = run(plant, settings);
        const RelayRecord& record = experiment.record;
        std::vector<double> switches;
        for (std::size_t i = 1; i < record.t.size(); ++i)
            if (record.u[i] != record.u[i - 1]) switches.push_back(record.t[i]);
        ASSERT_EQ(switches.size(), 80u);
        const LimitCycle& cycle = experiment.limit_cycle;
        EXPECT_NEAR(switches[79] - switches[77], cycle.Pu, 1e-8 * cycle.Pu);
        EXPECT_NEAR(switches[78] - switches[77], *cycle.t_plus, 1e-8 * cycle.Pu);
        EXPECT_GT(cycle.periods, 20);
        EXPECT_LE(cycle.periods, 40);
    }
}

// The first-order plant's response to the record's own u, by superposition of steps.
double superposed(const Fopdt& plant, const RelayRecord& record, double t) {
    double y = 0, before = 0;
    for (std::size_t i = 0; i < record.t.size() && record.t[i] + plant.L < t; ++i) {
        if (record.u[i] != before)
            y += plant.K * (record.u[i] - before) * -std::expm1(-(t - record.t[i] - plant.L) / plant.T);
        before = record.u[i];
    }
    return y;
}

TEST(Relay, EveryRowOfTheRecordIsExact) {
    const Fopdt plant{1, 10, 2};
    RelaySettings settings = relay(1.3, -0.7, 0.2);
    settings.record_interval = 0.7;
    const RelayRecord record = run(plant, settings).record;
    ASSERT_EQ(record.t.front(), 0);
    EXPECT_EQ(record.u.front(), 1.3);
    EXPECT_EQ(record.y.front(), 0);
    int grid = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        EXPECT_NEAR(record.y[i], superposed(plant, record, record.t[i]), 1e-9) << record.t[i];
        const bool switched = i > 0 && record.u[i] != record.u[i - 1];
        if (switched) {
            EXPECT_NEAR(std::abs(record.y[i]), 0.2, 1e-12) << record.t[i];
            EXPECT_EQ(record.u[i]<0, record.y[i]> 0) << record.t[i];
        } else {
            EXPECT_NEAR(record.t[i], 0.7 * grid, 1e-12 * record.t[i]);
            ++grid;
        }
    }
    EXPECT_EQ(grid, static_cast<int>(record.t.back() / 0.7) + 1);
}

TEST(Relay, WithoutHysteresisTheFirstSwitchComesWithTheFirstSignOfTheAnswer) {
    const RelayRecord record = run(Fopdt{1, 10, 2}, relay(1, -1, 0)).record;
    for (std::size_t i = 1; i < record.t.size(); ++i) {
        if (record.u[i] == record.u[i - 1]) continue;
        EXPECT_EQ(record.t[i], 2);
        break;
    }
}

TEST(Relay, AtRestOnItsThresholdAndWithoutDeadTimeTheStartIsHeldAndSaidSo) {
    const RelayExperiment experiment = run(TransferFunction{{1}, {1, 3, 3, 1}, 0}, relay(1, -1, 0));
    ASSERT_EQ(experiment.warnings.size(), 1u);
    EXPECT_EQ(experiment.warnings[0].code, "start-held");
    EXPECT_GT(experiment.limit_cycle.periods, 0);
}

TEST(Relay, TimeAndGainScale) {
    const LimitCycle one = run(Sopdt{1, 20, 2, 1}, relay(1.2, -1, 0.2)).limit_cycle;
    const LimitCycle slow = run(Sopdt{1, 20e6, 2e6, 1e6}, relay(1.2, -1, 0.2)).limit_cycle;
    EXPECT_NEAR(slow.Pu, 1e6 * one.Pu, 1e-3 * one.Pu);
    EXPECT_NEAR(slow.Au, one.Au, 1e-9);
    EXPECT_NEAR(*slow.y_max, *one.y_max, 1e-9);
    const LimitCycle large = run(Sopdt{500, 20, 2, 1}, relay(12, -10, 1000)).limit_cycle;
    EXPECT_NEAR(large.Pu, one.Pu, 1e-9 * one.Pu);
    EXPECT_NEAR(*large.y_min, 5000 * *one.y_min, 1e-5);
    EXPECT_NEAR(large.describing_function->Ku, one.describing_function->Ku / 500, 1e-9);
}

TEST(Relay, OnANegativeGainItIsReversedAndSaysSo) {
    const RelaySettings settings = relay(1.3, -0.7, 0.2);
    const RelayExperiment plain = run(Fopdt{1, 10, 2}, settings), turned = run(Fopdt{-1, 10, 2}, settings);
    EXPECT_FALSE(plain.reversed);
    ASSERT_TRUE(turned.reversed);
    ASSERT_EQ(turned.warnings.size(), 1u);
    EXPECT_EQ(turned.warnings[0].code, "relay-reversed");
    EXPECT_NEAR(turned.limit_cycle.Pu, plain.limit_cycle.Pu, 1e-9);
    EXPECT_NEAR(*turned.limit_cycle.y_min, -*plain.limit_cycle.y_max, 1e-9);
    EXPECT_NEAR(turned.limit_cycle.phi_u, plain.limit_cycle.phi_u - kPi, 1e-9);
    EXPECT_NEAR(turned.limit_cycle.describing_function->Ku, -plain.limit_cycle.describing_function->Ku, 1e-9);
    for (std::size_t i = 0; i < turned.record.t.size(); ++i) ASSERT_NEAR(turned.record.y[i], -plain.record.y[i], 1e-9);
}

TEST(Relay, AnUnstablePlantsDirectionIsThatOfItsFirstSlope) {
    EXPECT_FALSE(run(Fopdt{-1, -1, 0.4}, relay(1, -1, 0)).reversed);
    EXPECT_TRUE(run(Fopdt{1, -1, 0.4}, relay(1, -1, 0)).reversed);
}

TEST(Relay, PlantsThatNoRelayHoldsAreRefusedWithTheReason) {
    const auto beyond = simulate_relay(Fopdt{-1, -1, 0.7}, relay(1, -1, 0), {});
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().kind, ErrorKind::unsupported);
    EXPECT_NE(beyond.error().message.find("L/|T| is 0.7"), std::string::npos);
    const auto doubled = simulate_relay(TransferFunction{{1}, {1, 0, 0}, 1}, relay(1, -1, 0.1), {});
    ASSERT_FALSE(doubled);
    EXPECT_NE(doubled.error().message.find("double integrator"), std::string::npos);
    const auto undamped = simulate_relay(TransferFunction{{1}, {1, 0, 1}, 1}, relay(1, -1, 0.1), {});
    EXPECT_FALSE(undamped);
    // The bias narrows the range in which a relay holds the plant: e^(L/|T|) (eps + |K| u) < |K| (u_plus - u_minus).
    EXPECT_TRUE(simulate_relay(Fopdt{-1, -1, 0.42}, relay(1.3, -0.7, 0), {}));
    EXPECT_FALSE(simulate_relay(Fopdt{-1, -1, 0.44}, relay(1.3, -0.7, 0), {}));
}

// Between switches y oscillates with a period of a billionth of the dead time. A cycle that repeats after one such
// period would have billions of switches within the dead time: it is not searched for.
TEST(Relay, ADeadTimeOfBillionsOfSwingsIsRefusedWithoutCountingThem) {
    const OscillatorySopdt ringing{.K = 1, .T = 1e-9, .zeta = 0.1, .L = 3};
    const auto refused = simulate_relay(ringing, relay(1, -1, 0), {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::unsupported);
    EXPECT_EQ(refused.error().where, "plant");
    EXPECT_NE(refused.error().message.find("several oscillations"), std::string::npos);
}

TEST(Relay, ABiasOnAnIntegratingPlantIsAnsweredWithItsMeaning) {
    const RelayExperiment experiment = run(Ipdt{.K = 1, .L = 1}, relay(1.3, -0.7, 0.1));
    ASSERT_EQ(experiment.warnings.size(), 1u);
    EXPECT_EQ(experiment.warnings[0].code, "integrating-plant");
    const LimitCycle& cycle = experiment.limit_cycle;
    EXPECT_NEAR(1.3 * *cycle.t_plus - 0.7 * *cycle.t_minus, 0, 1e-9);
}

TEST(Relay, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    RunControl control;
    control.stop = source.get_token();
    RelaySettings settings = relay(1, -1, 0);
    settings.cycles = 1000;
    const auto stopped = simulate_relay(Zpk{1e12, {}, {-1.0, -1e6, -1e6}, 0.1}, settings, control);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::cancelled);
}

TEST(SampledRelayTest, EveryRowIsTheExactAnswerToTheHeldInput) {
    const Fopdt plant{1, 10, 2.37};  // the dead time ends inside a sample
    RelaySettings settings = relay(1.3, -0.7, 0.2);
    settings.relay_sample_time = 0.5;
    const RelayRecord record = run(plant, settings).record;
    ASSERT_GT(record.t.size(), 200u);
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        EXPECT_NEAR(record.t[i], 0.5 * static_cast<double>(i), 1e-9);
        EXPECT_NEAR(record.y[i], superposed(plant, record, record.t[i]), 1e-10);
        if (i == 0) continue;
        const double before = record.u[i - 1], y = record.y[i];
        EXPECT_EQ(record.u[i], y > 0.2 ? -0.7 : y < -0.2 ? 1.3 : before) << record.t[i];
    }
}

TEST(SampledRelayTest, ItsCycleTendsToTheExactOneAndIsLongerByTheTimeNotLooked) {
    const Plant plant = Fopdt{1, 10, 2};
    const double exact = run(plant, relay(1, -1, 0.2)).limit_cycle.Pu;
    for (const double Ts : {0.1, 0.01, 0.001}) {
        RelaySettings settings = relay(1, -1, 0.2);
        settings.relay_sample_time = Ts;
        settings.cycles = 2;
        const double Pu = run(plant, settings).limit_cycle.Pu;
        EXPECT_GE(Pu, exact);
        EXPECT_LE(Pu, exact + 5 * Ts);  // at most one sample late at each switch, and more by the slower oscillation
                                        // that follows
        EXPECT_NEAR(Pu / Ts, std::round(Pu / Ts), 1e-6);
    }
}

TEST(SampledRelayTest, NoiseIsWhiteWithItsDeviationAndIndependentOfTheMachine) {
    // From an independent implementation of the 64-bit Mersenne twister and of the transform.
    WhiteNoise seven(7);
    EXPECT_NEAR(seven.next(), 0.7130298338875809, 1e-14);
    EXPECT_NEAR(seven.next(), -0.23514359878547864, 1e-14);
    EXPECT_NEAR(seven.next(), 1.6105563141402495, 1e-14);
    EXPECT_NEAR(seven.next(), -1.3000776240143266, 1e-14);
    WhiteNoise noise(1);
    constexpr int kCount = 100'000;
    double sum = 0, squares = 0, neighbours = 0, before = 0;
    int beyond = 0;
    for (int i = 0; i < kCount; ++i) {
        const double n = noise.next();
        sum += n;
        squares += n * n;
        neighbours += n * before;
        before = n;
        beyond += n > 3;
    }
    const double root = std::sqrt(double{kCount});
    EXPECT_NEAR(sum / kCount, 0, 4 / root);
    EXPECT_NEAR(squares / kCount, 1, 4 * std::numbers::sqrt2 / root);
    EXPECT_NEAR(neighbours / kCount, 0, 4 / root);
    EXPECT_NEAR(beyond, kCount / 741.0, 4 * std::sqrt(kCount / 741.0));
}

TEST(SampledRelayTest, RecordsEveryNthSampleAndEverySwitch) {
    RelaySettings settings = relay(1, -1, 0.2);
    settings.relay_sample_time = 0.1;
    settings.record_interval = 1;
    const RelayRecord record = run(Fopdt{1, 10, 2}, settings).record;
    for (std::size_t i = 1; i < record.t.size(); ++i) {
        const bool whole = std::abs(record.t[i] - std::round(record.t[i])) < 1e-9;
        EXPECT_TRUE(whole || record.u[i] != record.u[i - 1]) << record.t[i];
    }
}

TEST(RelayPlanTest, StandsAboveTheNoiseAndComesTrue) {
    for (const double noise : {0.01, 0.05, 1.0}) {
        RelaySettings settings = relay(1.3, -0.7, 0.02);
        settings.noise_std = noise;
        settings.relay_sample_time = 0.05;
        const RelayPlan plan = run(Fopdt{1, 10, 2}, settings).plan;
        EXPECT_NEAR(plan.hysteresis, 3 * noise, 1e-12);
        EXPECT_GE(plan.amplitude, 2.999 * plan.hysteresis);
        EXPECT_NEAR(plan.u_plus / plan.u_minus, 1.3 / -0.7, 1e-9);
        const LimitCycle planned = run(Fopdt{1, 10, 2}, relay(plan.u_plus, plan.u_minus, plan.hysteresis)).limit_cycle;
        EXPECT_NEAR(planned.Pu, plan.expected_period, 1e-8 * planned.Pu);
        EXPECT_NEAR((*planned.y_max - *planned.y_min) / 2, plan.amplitude, 1e-8 * plan.amplitude);
        EXPECT_GE(plan.cycles, 10);
        EXPECT_NE(plan.reason.find("3 noise_std"), std::string::npos);
    }
}

TEST(RelayPlanTest, RowsAreAtRoundTimes) {
    for (const double T : {0.001, 0.7, 3.0, 40.0, 5000.0}) {
        const RelayPlan plan = run(Fopdt{1, T, 0.2 * T}, relay(1, -1, 0)).plan;
        const double first =
            plan.record_interval / std::pow(10.0, std::floor(std::log10(plan.record_interval * 1.001)));
        EXPECT_NEAR(std::min({std::abs(first - 1), std::abs(first - 2), std::abs(first - 5)}), 0, 1e-9) << T;
        const double rows = plan.expected_period / plan.record_interval;
        EXPECT_GE(rows, 200) << T;
        EXPECT_LT(rows, 500) << T;
    }
}

}  // namespace
}  // namespace tunewright
