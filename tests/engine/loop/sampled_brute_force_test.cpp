#include <gtest/gtest.h>

#include <set>

#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/sampled/sampled_response.h"
#include "tests/engine/loop/sampled_cases.h"

namespace tunewright {
namespace {

using namespace test;

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

/// `rounds` laws for every plant: sample times, dead times and rules change from one to the next.
std::vector<SampledCase> cases(int rounds) {
    constexpr std::array kSampleTimes = {0.5, 0.2, 0.1, 0.03, 0.01};
    constexpr std::array kDeadTimes = {0.0, 0.17, 0.5, 1.3, 4.0};
    constexpr std::array<long, 3> kDelays = {0, 3 * kParts / 10, 17 * kParts / 10};  // 0, 0.3 and 1.7 sample times
    Random random(4);
    std::vector<SampledCase> all;
    int i = 0;
    for (int round = 0; round < rounds; ++round)
        for (const KnownPlant& plant : known_plants()) {
            ++i;
            // If nothing stabilises the plant with so long a dead time or sample time, a shorter one is tried.
            std::optional<SampledCase> found;
            double Ts = kSampleTimes[std::size_t(i) % kSampleTimes.size()];
            double dead = kDeadTimes[std::size_t(i / 5 + round) % kDeadTimes.size()];
            for (int shorter = 0; shorter < 6 && !found; ++shorter, dead *= 0.4, Ts *= shorter % 2 == 0 ? 1 : 0.4) {
                const long parts = i % 3 == 0 ? kParts * std::lround(dead / Ts) : std::lround(kParts * dead / Ts);
                found = random_case(plant, random, Ts, parts, kDelays[std::size_t(i / 2) % 3], (i + round) % 3, i % 6,
                                    (i / 3 + round) % 4, i % 11 != 0 || shorter > 0);
            }
            if (found) all.push_back(std::move(*found));
        }
    return all;
}

const std::vector<SampledCase>& the_cases() {
    static const std::vector<SampledCase> all = cases(4);
    return all;
}

TEST(SampledBruteForce, TheCasesHaveEveryPlantAndEveryRule) {
    std::set<int> integral, derivative, filter;
    std::set<std::string> plants;
    for (const SampledCase& c : the_cases()) {
        integral.insert(int(c.law.integral));
        derivative.insert(int(c.law.derivative));
        filter.insert(int(c.law.gains.filter.type));
        plants.insert(c.name.substr(0, c.name.find(", Ts")));
    }
    EXPECT_EQ(plants.size(), known_plants().size());
    EXPECT_EQ(integral.size(), 3u);
    EXPECT_EQ(derivative.size(), 6u);
    EXPECT_EQ(filter.size(), 4u);
    EXPECT_GE(the_cases().size(), 110u);
}

// The transform of the samples after a pulse: truncated at 1e-11 of the largest, which leaves about 1e-8 for a slow
// loop.
TEST(SampledBruteForce, PeaksAreThoseOfTheSamplesAfterAPulse) {
    for (const SampledCase& c : the_cases()) {
        SCOPED_TRACE(c.name);
        const LinearPlant plant = *LinearPlant::make(c.plant);
        const SampledLoop loop(plant, c.law);
        EXPECT_TRUE(count_unstable_poles(loop).stable());
        const Peaks peaks = find_peaks(loop, make_peak_grid(loop));
        const BrutePeaks brute = peaks_of(c.pulse);
        EXPECT_LT(relative(peaks.S.value, brute.S), 1e-7) << peaks.S.value << ' ' << brute.S;
        EXPECT_LT(relative(peaks.T.value, brute.T), 1e-7) << peaks.T.value << ' ' << brute.T;
        EXPECT_LT(relative(peaks.CS.value, brute.CS), 1e-7) << peaks.CS.value << ' ' << brute.CS;
    }
}

// The continuous y in two thousand parts per period, linear between them (in kParts for many periods): below 1e-6 of
// the whole.
TEST(SampledBruteForce, IntegralsOfTheErrorAreThoseOfTheContinuousOutput) {
    int i = 0, finely = 0;
    for (const SampledCase& c : the_cases()) {
        SCOPED_TRACE(c.name);
        const bool quick = c.pulse.S.size() < 1000 && finely < 32;  // to rest, in samples
        if (++i % 2 == 0 && !quick) continue;
        finely += quick;
        const LinearPlant plant = *LinearPlant::make(c.plant);
        const BruteForce brute{c.own, c.dead_time, c.law, quick ? 2000 : int(kParts)};
        for (const StepInputs in : {StepInputs{1, 0}, StepInputs{0, 1}}) {
            if (!quick && (i % 4 < 2) == (in.r != 0)) continue;
            const StepResponse response = simulate_sampled(plant, c.law, {}, in, {});
            EXPECT_TRUE(response.settles);
            const double IAE = integral_of_absolute_error(response.nodes, in.r, response.error_integral_final);
            const BruteResponse expected = brute.respond(in.r, in.d, in.r);
            EXPECT_LT(relative(IAE, expected.IAE), 1e-6) << in.r << ' ' << IAE << ' ' << expected.IAE;
            EXPECT_NEAR(*response.error_integral_final, expected.error_integral, 1e-6 * expected.IAE);
            const Extremes extremes = extremes_of_y(response.nodes);
            EXPECT_NEAR(extremes.max, expected.y_max, 1e-5 * (expected.y_max - expected.y_min));
            EXPECT_NEAR(extremes.min, expected.y_min, 1e-5 * (expected.y_max - expected.y_min));
            EXPECT_LT(relative(total_variation(response.nodes), expected.TV), 1e-6);
            EXPECT_EQ(response.nodes.front().t, 0);
        }
    }
    EXPECT_GE(finely, 30);
}

// C S rises to pi/Ts while the dead time turns L eighteen times as fast as z: the highest of its ripples is between two
// points of a grid made from S alone.
TEST(SampledBruteForce, FindsTheHighestRippleOfTheControllersOutput) {
    SampledPid law{.gains = {.Kp = 0, .Ki = 0.78552787476650243, .Kd = 0.1065559254683302}, .Ts = 0.03};
    law.integral = IntegralRule::forward;
    law.computation_delay = 0.009;
    const LinearPlant plant = *LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = 0.51});
    const SampledLoop loop(plant, law);
    const auto pulse = pulse_response_of(OwnLoop(OwnPlant({1}, {1, 1}), 0.51, law), 6000, 18);
    ASSERT_TRUE(pulse);
    EXPECT_LT(relative(find_peaks(loop, make_peak_grid(loop)).CS.value, peaks_of(*pulse).CS), 1e-7);
}

TEST(SampledLoop, AtRestItFollowsTheSetPointExactlyWithAnIntegrator) {
    const SampledPid law{.gains = {.Kp = 0.2, .Ki = 0.1}, .Ts = 0.3};
    const LinearPlant lag = *LinearPlant::make(Fopdt{.K = 2, .T = 1, .L = 0.4}),
                      integrator = *LinearPlant::make(Ipdt{.K = 0.3, .L = 0.4});
    const SampledLoop loop(lag, law);
    const Peaks peaks = find_peaks(loop, make_peak_grid(loop));
    EXPECT_EQ(peaks.T.value, 1);
    EXPECT_EQ(peaks.T.omega, 0);
    EXPECT_EQ(peaks.CS.value, 0.5);  // 1/K: the move of u for a move of y by one
    const SampledPid proportional{.gains = {.Kp = 0.5}, .Ts = 0.3};
    const SampledLoop by_plant(integrator, proportional);
    EXPECT_EQ(find_peaks(by_plant, make_peak_grid(by_plant)).T.value, 1);
}

// A hold delays everything by Ts/2, to first order. If the dead time is reduced by that, the error of the trapezoidal
// rules is of second order.
TEST(SampledLoop, TendsToTheContinuousLoopByTheOrderOfItsRules) {
    ParallelPid gains{.Kp = 1.3, .Ki = 1.2, .Kd = 0.25, .filter = {FilterType::derivative, 0.1}};
    const auto own = [&](double L) { return *LinearPlant::make(Sopdt{.K = 1, .T1 = 1, .T2 = 0.3, .L = L}); };
    const LinearPlant plant = own(0.4);
    const Loop loop = *Loop::make(plant, gains);
    const Peaks exact = find_peaks(loop, make_peak_grid(loop));
    ResponseOptions fine;
    fine.tolerance = 1e-9;
    fine.settled = 1e-9;
    const StepResponse load = simulate_linear(plant, gains, {0, 1}, fine);
    const double IAE = integral_of_absolute_error(load.nodes, 0, load.error_integral_final);
    struct Errors {
        double S, T, IAE;
    };
    const auto errors = [&](double Ts, bool second_order) {
        const LinearPlant seen = own(second_order ? 0.4 - 0.5 * Ts : 0.4);
        SampledPid law{.gains = gains, .Ts = Ts};
        if (second_order) {
            law.integral = IntegralRule::trapezoidal;
            law.derivative = DerivativeRule::filtered_trapezoidal;
        }
        const SampledLoop sampled(seen, law);
        const Peaks peaks = find_peaks(sampled, make_peak_grid(sampled));
        const StepResponse response = simulate_sampled(seen, law, {}, {0, 1}, {});
        return Errors{peaks.S.value - exact.S.value, peaks.T.value - exact.T.value,
                      integral_of_absolute_error(response.nodes, 0, response.error_integral_final) - IAE};
    };
    const Errors first_2 = errors(0.004, false), first_1 = errors(0.002, false);
    EXPECT_NEAR(first_2.S / first_1.S, 2, 0.05);
    EXPECT_NEAR(first_2.T / first_1.T, 2, 0.05);
    EXPECT_NEAR(first_2.IAE / first_1.IAE, 2, 0.05);
    const Errors second_2 = errors(0.04, true), second_1 = errors(0.02, true);
    EXPECT_NEAR(second_2.S / second_1.S, 4, 0.2);
    EXPECT_NEAR(second_2.T / second_1.T, 4, 0.2);
    EXPECT_NEAR(second_2.IAE / second_1.IAE, 4, 0.4);
    EXPECT_LT(std::abs(second_1.S), 2e-3);
}

}  // namespace
}  // namespace tunewright
