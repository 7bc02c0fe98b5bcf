// Parameters identified from simulated records, scaling laws, warnings, progress.
#include "engine/identification/identify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::HasSubstr;

TEST(Identify, DeadTimeBetweenSamplesIsExact) {
    for (const double L : {0.0, 0.137, 0.5, 3.377, 3.999}) {
        const auto plant = plant_as<Fopdt>(
            identified(simulate(even_times(200, 0.5), 0, 0, {{5, 1}}, first_order(2, 8, L)), ModelChoice::fopdt));
        EXPECT_NEAR(plant.K, 2, 1e-6) << L;
        EXPECT_NEAR(plant.T, 8, 1e-5) << L;
        EXPECT_NEAR(plant.L, L, 1e-5) << L;
    }
}

// 100,000 samples are fitted as means over blocks of five. The steps are inside blocks, and the last plant's lag is two
// blocks of that length: it is fitted to more samples.
TEST(Identify, ThinningALongRecordChangesNoParameter) {
    for (const double T : {2000.0, 500.0, 60.0, 10.0}) {
        Record record =
            simulate(even_times(100'000, 1), 0, 20, {{5003, 1}, {31'002, -1}, {67'001, 2}}, first_order(2, T, T / 7));
        add_noise(record, 0.02, 5);
        const IdentifiedModel model = identified(record, ModelChoice::fopdt);
        const auto plant = plant_as<Fopdt>(model);
        const auto& error = model.standard_errors;
        constexpr double kSigmas = 4;
        EXPECT_NEAR(plant.K, 2, kSigmas * error.at("K")) << T;
        EXPECT_NEAR(plant.T, T, std::min(kSigmas * error.at("T"), 2e-3 * T)) << T;
        EXPECT_NEAR(plant.L, T / 7, std::min(kSigmas * error.at("L"), 2e-3 * T)) << T;
    }
}

TEST(Identify, IrregularTimesCostNoAccuracy) {
    std::vector<double> t = {0};
    std::mt19937 bits(7);
    while (t.size() < 150) t.push_back(t.back() + 0.02 + 1.3 * (bits() % 1000) / 1000.0);
    t.push_back(10.25);
    t.push_back(41.5);
    std::sort(t.begin(), t.end());
    const IdentifiedModel model =
        identified(simulate(t, 1, 5, {{10.25, 3}, {41.5, 2}}, two_lags(-1.5, 9, 3, 2.2)), ModelChoice::sopdt);
    const auto plant = plant_as<Sopdt>(model);
    EXPECT_NEAR(plant.K, -1.5, 1e-5);
    EXPECT_NEAR(plant.T1, 9, 1e-4);
    EXPECT_NEAR(plant.T2, 3, 1e-4);
    EXPECT_NEAR(plant.L, 2.2, 1e-4);
    EXPECT_TRUE(model.data_quality.irregular);
    EXPECT_EQ(model.data_quality.steps, 2);
}

TEST(Identify, OscillatoryResponseIsFoundByAuto) {
    Record record = simulate(even_times(400, 0.25), 0, 0, {{5, 1}}, oscillation(0.8, 3, 0.25, 1.1));
    add_noise(record, 0.01, 3);
    const IdentifiedModel model = identified(record);
    const auto plant = plant_as<OscillatorySopdt>(model);
    EXPECT_NEAR(plant.K, 0.8, 4 * model.standard_errors.at("K"));
    EXPECT_NEAR(plant.T, 3, 4 * model.standard_errors.at("T"));
    EXPECT_NEAR(plant.zeta, 0.25, 4 * model.standard_errors.at("zeta"));
    EXPECT_NEAR(plant.L, 1.1, 4 * model.standard_errors.at("L"));
    EXPECT_LT(model.standard_errors.at("zeta"), 0.01);
}

TEST(Identify, EqualLagsHaveFiniteStandardErrors) {
    Record record = simulate(even_times(300, 0.2), 0, 0, {{5, 1}},
                             [](double t) { return t <= 1 ? 0 : 1 - (1 + (t - 1) / 4) * std::exp(-(t - 1) / 4); });
    add_noise(record, 0.005, 11);
    const IdentifiedModel model = identified(record, ModelChoice::sopdt);
    for (const auto& [name, error] : model.standard_errors) EXPECT_TRUE(std::isfinite(error) && error > 0) << name;
}

TEST(Identify, LaggedIntegratorIsRecovered) {
    Record record = simulate(even_times(300, 0.5), 2, 40, {{20, 3}, {80, 1.5}}, ramp(0.3, 2.5, 6));
    add_noise(record, 0.05, 5);
    const IdentifiedModel model = identified(record);
    const auto plant = plant_as<Ipdt>(model);
    EXPECT_NEAR(plant.K, 0.3, 4 * model.standard_errors.at("K"));
    EXPECT_NEAR(plant.T, 6, 4 * model.standard_errors.at("T"));
    EXPECT_NEAR(plant.L, 2.5, 4 * model.standard_errors.at("L"));
}

TEST(Identify, IntegratorThatDriftsBeforeTheStepKeepsItsGain) {
    // With the gain 0.3 a drift of 0.06 equals 0.2 of u: y rests at u = 2.2, and the record begins with u = 2.
    Record record = simulate(even_times(200, 1), 2, 40, {{60, 3}}, ramp(0.3, 4));
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] -= 0.06 * record.t[i];
    add_noise(record, 0.05, 9);
    const IdentifiedModel model = identified(record);
    const auto plant = plant_as<Ipdt>(model);
    EXPECT_NEAR(plant.K, 0.3, 4 * model.standard_errors.at("K"));
    EXPECT_NEAR(plant.L, 4, 4 * model.standard_errors.at("L"));
    EXPECT_THAT(model.data_quality.notes, ::testing::Contains(HasSubstr("y is at rest for u = 2.")));
}

TEST(Identify, StepBeforeTheFirstSampleNeedsU0) {
    Record record = simulate(even_times(160, 0.5), 50, 20, {}, first_order(0.6, 15, 2));
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += 10 * first_order(0.6, 15, 2)(record.t[i]);
    EXPECT_THAT(refusal(record).message, HasSubstr("give u0"));
    record.u0 = 40;
    const auto plant = plant_as<Fopdt>(identified(record));
    EXPECT_NEAR(plant.K, 0.6, 1e-5);
    EXPECT_NEAR(plant.T, 15, 1e-3);
    EXPECT_NEAR(plant.L, 2, 1e-3);
}

TEST(Identify, GivenY0DecidesWhatAResponseUnderWayLeavesOpen) {
    // The first sample comes 6 s after the step: gain, dead time and offset of an exponential cannot be separated
    // without y0.
    Record record = simulate(even_times(120, 0.5), 1, 5, {}, first_order(1, 1, 0));
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += first_order(2, 8, 0)(record.t[i]);
    record.u0 = 0;
    record.y0 = 5;
    const auto plant = plant_as<Fopdt>(identified(record, ModelChoice::fopdt));
    EXPECT_NEAR(plant.K, 2, 1e-4);
    EXPECT_NEAR(plant.T, 8, 1e-3);
}

TEST(Identify, RecordThatStartsInTheMiddleOfAnEarlierResponseIsUnderstood) {
    Record record = simulate(even_times(300, 0.5), 3, 10, {{0, 1}, {40, 2}, {90, 0.5}}, first_order(2, 12, 3));
    add_noise(record, 0.01, 21);
    const IdentifiedModel model = identified(record);
    const auto plant = plant_as<Fopdt>(model);
    EXPECT_NEAR(plant.K, 2, 4 * model.standard_errors.at("K"));
    EXPECT_NEAR(plant.T, 12, 4 * model.standard_errors.at("T"));
    EXPECT_NEAR(plant.L, 3, 4 * model.standard_errors.at("L"));
    EXPECT_THAT(model.data_quality.notes, ::testing::Contains(HasSubstr("y is at rest for u = 3")));
}

TEST(Identify, RepeatedTimesUseTheLastInputAndEveryMeasurement) {
    Record record = simulate(even_times(100, 1), 0, 20, {{0, 50}}, first_order(0.7, 12, 2));
    record.t.insert(record.t.begin(), 0);
    record.u.insert(record.u.begin(), 0);
    record.y.insert(record.y.begin(), 20);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_NEAR(plant_as<Fopdt>(model).K, 0.7, 1e-5);
    EXPECT_NEAR(plant_as<Fopdt>(model).L, 2, 1e-4);
    EXPECT_EQ(model.data_quality.samples, 101);
    EXPECT_EQ(model.data_quality.samples_dropped, 0);
    EXPECT_EQ(model.data_quality.steps, 1);
}

TEST(Identify, BackwardTimesAndMissingNumbersAreDroppedAndCounted) {
    Record record = simulate(even_times(200, 0.5), 0, 0, {{5, 1}}, first_order(2, 8, 1.3));
    record.t[50] = 1;
    record.y[10] = std::numeric_limits<double>::quiet_NaN();  // the row of the step: its u must count
    record.u[90] = std::numeric_limits<double>::quiet_NaN();
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    // The row whose u is missing keeps its y.
    EXPECT_EQ(model.data_quality.samples_dropped, 2);
    EXPECT_EQ(model.data_quality.samples, 198);
    EXPECT_EQ(model.data_quality.backward_times, 1);
    ASSERT_TRUE(model.data_quality.missing);
    EXPECT_EQ(model.data_quality.missing->count, 1);
    EXPECT_DOUBLE_EQ(model.data_quality.missing->longest, 1);
    EXPECT_NEAR(plant_as<Fopdt>(model).L, 1.3, 1e-5);
}

TEST(Identify, PlantScalesWithTheUnitsOfTheRecord) {
    Record record = simulate(even_times(300, 0.4), 0, 0, {{8, 1}, {60, -0.5}}, two_lags(1.5, 10, 4, 2));
    add_noise(record, 0.01, 1);
    const IdentifiedModel original = identified(record);
    const auto plant = plant_as<Sopdt>(original);
    for (const double time : {1e-6, 86400.0}) {
        Record scaled = record;
        for (double& t : scaled.t) t = t * time + 5e3 * time;
        for (double& u : scaled.u) u = 1e4 * u + 37;
        for (double& y : scaled.y) y = -2e-5 * y + 4;
        const IdentifiedModel model = identified(scaled);
        const auto got = plant_as<Sopdt>(model);
        const double gain = -2e-5 / 1e4;
        EXPECT_NEAR(got.K / (plant.K * gain), 1, 1e-6);
        EXPECT_NEAR(got.T1 / (plant.T1 * time), 1, 1e-5);
        EXPECT_NEAR(got.T2 / (plant.T2 * time), 1, 1e-5);
        EXPECT_NEAR(got.L / (plant.L * time), 1, 1e-5);
        EXPECT_NEAR(model.standard_errors.at("L") / (original.standard_errors.at("L") * time), 1, 1e-3);
        EXPECT_NEAR(model.standard_errors.at("K") / (original.standard_errors.at("K") * std::abs(gain)), 1, 1e-3);
        EXPECT_NEAR(model.fit_percent, original.fit_percent, 1e-6);
    }
}

/// Root mean square of the errors of K, T, L over many noises, in standard errors.
std::map<std::string, double> normalised_errors(double noise, double pole, unsigned first_seed, int runs) {
    std::map<std::string, double> squares;
    for (int run = 0; run < runs; ++run) {
        Record record = simulate(even_times(400, 0.5), 10, 50, {{20, 15}}, first_order(1.2, 18, 4.3));
        add_noise(record, noise, first_seed + static_cast<unsigned>(run), pole);
        const IdentifiedModel model = identified(record, ModelChoice::fopdt);
        const auto got = plant_as<Fopdt>(model);
        const std::map<std::string, double> error = {{"K", got.K - 1.2}, {"T", got.T - 18}, {"L", got.L - 4.3}};
        for (const auto& [name, value] : error)
            squares[name] += std::pow(value / model.standard_errors.at(name), 2) / runs;
    }
    for (auto& [name, square] : squares) square = std::sqrt(square);
    return squares;
}

TEST(Identify, StandardErrorsAreTrueForWhiteNoise) {
    // 60 runs: the root mean square of a unit normal lies in 1 +- 0.27 with three standard deviations.
    for (const auto& [name, ratio] : normalised_errors(0.05, 0, 100, 60)) {
        EXPECT_GT(ratio, 0.7) << name;
        EXPECT_LT(ratio, 1.3) << name;
    }
}

TEST(Identify, StandardErrorsStayHonestForSlowNoise) {
    // Naive standard errors would be too small by sqrt((1 + 0.9)/(1 - 0.9)) = 4.4 for the gain.
    for (const auto& [name, ratio] : normalised_errors(0.05, 0.9, 500, 60)) {
        EXPECT_GT(ratio, 0.35) << name;
        EXPECT_LT(ratio, 1.6) << name;
    }
}

TEST(Identify, QuantisedRecordsStayWithinFourStandardErrors) {
    for (int run = 0; run < 20; ++run) {
        const double K = 0.9 + 0.013 * run, T = 14 + 0.7 * run, L = 3 + 0.21 * run;
        Record record = simulate(even_times(250, 0.8), 0, 7, {{8, 2}}, first_order(K, T, L));
        for (double& y : record.y) y = 0.05 * std::round(y / 0.05);
        const IdentifiedModel model = identified(record, ModelChoice::fopdt);
        const auto got = plant_as<Fopdt>(model);
        EXPECT_NEAR(got.K, K, 4 * model.standard_errors.at("K")) << run;
        EXPECT_NEAR(got.T, T, 4 * model.standard_errors.at("T")) << run;
        EXPECT_NEAR(got.L, L, 4 * model.standard_errors.at("L")) << run;
        EXPECT_LT(model.standard_errors.at("K"), 0.03) << run;
    }
}

TEST(Identify, AutoPrefersOneLagWhereTheNoiseHidesAnother) {
    int simple = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        Record record = simulate(even_times(300, 0.5), 0, 0, {{10, 1}}, first_order(1, 15, 5));
        add_noise(record, 0.02, 1000 + seed);
        simple += std::holds_alternative<Fopdt>(identified(record).plant);
    }
    EXPECT_GE(simple, 19);
}

TEST(Identify, ManyChangesOfInputDoNotTrapTheDeadTime) {
    Steps steps;
    std::mt19937 bits(5);
    for (double t = 3; t < 180; t += 4 + bits() % 9) steps.emplace_back(t, static_cast<double>(bits() % 2) * 2 - 1);
    Record record = simulate(even_times(400, 0.5), 0, 1, steps, first_order(3, 6, 17.3));
    add_noise(record, 0.1, 77);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    const auto plant = plant_as<Fopdt>(model);
    EXPECT_NEAR(plant.L, 17.3, 4 * model.standard_errors.at("L"));
    EXPECT_NEAR(plant.T, 6, 4 * model.standard_errors.at("T"));
}

TEST(Identify, UnsettledRecordWarnsAndSaysHowMuchIsMissing) {
    Record record = simulate(even_times(120, 0.25), 0, 0, {{5, 1}}, first_order(1.5, 20, 2));
    add_noise(record, 0.003, 8);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_TRUE(warns(model, "unsettled-record"));
    EXPECT_FALSE(model.data_quality.settled);
}

TEST(Identify, DriftSeenBeforeTheStepIsFittedAndTold) {
    Record record = simulate(even_times(200, 0.5), 0, 0, {{30, 1}}, first_order(1, 10, 3));
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += 0.004 * record.t[i];
    add_noise(record, 0.005, 4);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_TRUE(warns(model, "drift"));
    const auto plant = plant_as<Fopdt>(model);
    EXPECT_NEAR(plant.K, 1, 4 * model.standard_errors.at("K"));
    EXPECT_NEAR(plant.T, 10, 4 * model.standard_errors.at("T"));
    EXPECT_LT(model.standard_errors.at("K"), 0.02);
}

TEST(Identify, AStepCutShortMayBeSlowOrIntegratingAndSaysSo) {
    Record record = simulate(even_times(80, 0.25), 0, 0, {{5, 1}}, first_order(1, 30, 3));
    add_noise(record, 0.02, 6);
    const IdentifiedModel model = identified(record);
    if (std::holds_alternative<Ipdt>(model.plant)) {
        EXPECT_TRUE(warns(model, "slow-or-integrating"));
    } else {
        EXPECT_TRUE(warns(model, "unsettled-record"));
    }
    Record ramp = simulate(even_times(400, 0.25), 0, 0, {{5, 1}}, testing::ramp(0.05, 3));
    add_noise(ramp, 0.02, 6);
    EXPECT_FALSE(warns(identified(ramp), "slow-or-integrating"));
}

TEST(Identify, MovingBeforeTheStepWarnsWhereTooLittleIsSeenToFitADrift) {
    Record record = simulate(even_times(200, 0.5), 0, 0, {{6, 1}}, first_order(1, 10, 3));
    for (std::size_t i = 0; i < record.t.size(); ++i) record.y[i] += 0.01 * record.t[i];
    add_noise(record, 0.005, 4);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_TRUE(warns(model, "not-at-rest") || warns(model, "uncertain-parameters"));
    EXPECT_TRUE(warns(model, "structured-residuals"));
}

TEST(Identify, FitTraceIsDecimatedAndKeepsBothEnds) {
    const IdentifiedModel model =
        identified(simulate(even_times(5001, 0.02), 0, 0, {{5, 1}}, first_order(2, 8, 1)), ModelChoice::fopdt);
    EXPECT_EQ(model.fit.t.size(), 2000u);
    EXPECT_EQ(model.fit.y_model.size(), 2000u);
    EXPECT_DOUBLE_EQ(model.fit.t.front(), 0);
    EXPECT_NEAR(model.fit.t.back(), 100, 1e-9);
    EXPECT_NEAR(model.fit.y_model.back(), model.fit.y.back(), 1e-6);
}

TEST(Identify, CandidatesAreSortedAndTheChoiceIsExplained) {
    Record record = simulate(even_times(300, 0.5), 0, 0, {{10, 1}}, first_order(1, 15, 5));
    add_noise(record, 0.02, 3);
    const IdentifiedModel model = identified(record);
    ASSERT_GE(model.candidates.size(), 4u);
    for (std::size_t i = 1; i < model.candidates.size(); ++i)
        EXPECT_LE(model.candidates[i - 1].criterion, model.candidates[i].criterion);
    EXPECT_THAT(model.choice_reason, HasSubstr("fopdt"));
    EXPECT_THAT(identified(record, ModelChoice::sopdt).choice_reason, HasSubstr("requested"));
}

TEST(Identify, RecordFromNewestToOldestIsTurnedRoundAndSaid) {
    const Record record = simulate(even_times(200, 0.5), 0, 0, {{5, 1}}, first_order(2, 8, 1.3));
    Record backward = record;
    for (auto* column : {&backward.t, &backward.u, &backward.y}) std::reverse(column->begin(), column->end());
    const IdentifiedModel model = identified(backward, ModelChoice::fopdt);
    EXPECT_NEAR(plant_as<Fopdt>(model).K, 2, 1e-6);
    EXPECT_NEAR(plant_as<Fopdt>(model).L, 1.3, 1e-5);
    EXPECT_TRUE(warns(model, "reversed-time"));
}

TEST(Identify, ReportsProgressAndStopsWhenAsked) {
    const Record record = simulate(even_times(200, 0.5), 0, 0, {{5, 1}}, first_order(2, 8, 1));
    std::stop_source source;
    std::vector<double> fractions;
    RunControl control;
    control.stop = source.get_token();
    control.progress = [&](const Progress& p) {
        EXPECT_EQ(p.stage, "identify");
        fractions.push_back(p.fraction);
    };
    EXPECT_TRUE(identify(record, {}, control));
    EXPECT_GE(fractions.size(), 5u);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.back(), 1);

    control.progress = [&](const Progress& p) {
        if (p.fraction > 0.3) source.request_stop();
    };
    auto stopped = identify(record, {}, control);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::cancelled);
}

}  // namespace
}  // namespace tunewright
