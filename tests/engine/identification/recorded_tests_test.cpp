// The recorded tests in tests/data/records: true parameters as stated there, with tolerances.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "engine/plant/linear/linear_plant.h"
#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/record_files.h"

namespace tunewright {
namespace {

using testing::identified;
using testing::read_record;
using testing::refusal;

void expect_relative(double got, double want, double tolerance, const char* what) {
    EXPECT_NEAR(got, want, tolerance * std::abs(want)) << what;
}

void expect_fopdt(const IdentifiedModel& model, const Fopdt& want, const Fopdt& tolerance) {
    ASSERT_TRUE(std::holds_alternative<Fopdt>(model.plant)) << model.choice_reason;
    const auto& got = std::get<Fopdt>(model.plant);
    expect_relative(got.K, want.K, tolerance.K, "K");
    expect_relative(got.T, want.T, tolerance.T, "T");
    expect_relative(got.L, want.L, tolerance.L, "L");
}

TEST(RecordedTests, CleanFopdtStepIsRecoveredToItsPrintedDigits) {
    expect_fopdt(identified(read_record("step_fopdt_clean.csv")), {1.5, 12, 3}, {1e-5, 1e-5, 2e-5});
}

TEST(RecordedTests, QuantisedStepIsFopdtWithinItsErrors) {
    const IdentifiedModel model = identified(read_record("step_quantised.csv"));
    expect_fopdt(model, {1, 20, 5}, {0.01, 0.03, 0.05});
    EXPECT_NEAR(model.data_quality.quantisation, 0.05, 1e-9);
    EXPECT_LT(std::abs(std::get<Fopdt>(model.plant).L - 5), 3 * model.standard_errors.at("L"));
}

TEST(RecordedTests, StepFarFromZeroIsFopdt) {
    const IdentifiedModel model = identified(read_record("step_offset_units.csv"));
    expect_fopdt(model, {0.6, 40, 8}, {0.01, 0.02, 0.03});
    EXPECT_NEAR(model.data_quality.noise_std, 0.02, 0.004);
    EXPECT_TRUE(model.data_quality.settled);
    EXPECT_TRUE(model.warnings.empty());
}

TEST(RecordedTests, NoisySecondOrderStepIsSopdt) {
    const IdentifiedModel model = identified(read_record("step_sopdt_noisy.csv"));
    ASSERT_TRUE(std::holds_alternative<Sopdt>(model.plant)) << model.choice_reason;
    const auto& got = std::get<Sopdt>(model.plant);
    expect_relative(got.K, 2, 0.01, "K");
    expect_relative(got.T1 + got.T2, 14, 0.03, "T1 + T2");
    expect_relative(got.T1 * got.T2, 40, 0.06, "T1 T2");
    expect_relative(got.L, 2, 0.1, "L");
}

TEST(RecordedTests, RampIsIntegrating) {
    const IdentifiedModel model = identified(read_record("step_integrating_ramp.csv"));
    ASSERT_TRUE(std::holds_alternative<Ipdt>(model.plant)) << model.choice_reason;
    const auto& got = std::get<Ipdt>(model.plant);
    expect_relative(got.K, 0.04, 0.01, "K");
    expect_relative(got.L, 6, 0.03, "L");
    EXPECT_EQ(got.T, 0);
    EXPECT_FALSE(model.data_quality.settled);
}

TEST(RecordedTests, InverseResponseNeedsAZero) {
    const IdentifiedModel model = identified(read_record("step_inverse_response.csv"));
    ASSERT_TRUE(std::holds_alternative<TransferFunction>(model.plant)) << model.choice_reason;
    const auto& got = std::get<TransferFunction>(model.plant);
    expect_relative(got.num[1], 1, 0.01, "K");
    expect_relative(got.num[0], -3, 0.04, "K b");
    expect_relative(got.den[1], 10, 0.02, "a1");
    expect_relative(got.den[0], 16, 0.04, "a2");
    expect_relative(got.L, 1, 0.06, "L");
}

TEST(RecordedTests, FopdtOfAnInverseResponseIsFlagged) {
    const IdentifiedModel model = identified(read_record("step_inverse_response.csv"), ModelChoice::fopdt);
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_EQ(model.warnings.front().code, "structured-residuals");
    // y rests before the step: no other initial state may replace the missing zero and change the gain.
    EXPECT_NEAR(std::get<Fopdt>(model.plant).K, 1, 0.05);
}

TEST(RecordedTests, ConstantInputIsRefusedWithTheCure) {
    const Error error = refusal(read_record("step_missing_excitation.csv"));
    EXPECT_EQ(error.kind, ErrorKind::not_identifiable);
    EXPECT_THAT(error.message, ::testing::HasSubstr("u never moves"));
    EXPECT_THAT(error.message, ::testing::HasSubstr("Record a test in which u changes"));
}

TEST(RecordedTests, RelayRecordThatDoesNotShowTheLevelBeforeItIsFitted) {
    const IdentifiedModel model = identified(read_record("relay_ex3_unbiased.csv"));
    ASSERT_TRUE(std::holds_alternative<Sopdt>(model.plant)) << model.choice_reason;
    const auto& got = std::get<Sopdt>(model.plant);
    expect_relative(got.K, 1, 1e-3, "K");
    expect_relative(got.T1, 20, 1e-3, "T1");
    expect_relative(got.T2, 2, 1e-3, "T2");
    expect_relative(got.L, 1, 1e-3, "L");
}

TEST(RecordedTests, RelayOnAnIntegratorIsIntegrating) {
    const IdentifiedModel model = identified(read_record("relay_integrating_unbiased.csv"));
    ASSERT_TRUE(std::holds_alternative<Ipdt>(model.plant)) << model.choice_reason;
    expect_relative(std::get<Ipdt>(model.plant).K, 0.05, 1e-3, "K");
    expect_relative(std::get<Ipdt>(model.plant).L, 4, 1e-3, "L");
}

TEST(RecordedTests, UnstablePlantUnderARelayHasANegativeTimeConstant) {
    for (const ModelChoice choice : {ModelChoice::automatic, ModelChoice::fopdt}) {
        // 1/(s - 1) is K = -1, T = -1.
        expect_fopdt(identified(read_record("relay_unstable_unbiased.csv"), choice), {-1, -1, 0.4}, {1e-3, 1e-3, 1e-3});
    }
}

TEST(RecordedTests, HiddenLoadIsFittedAndTold) {
    const IdentifiedModel model = identified(read_record("relay_ex1_biased_load_offset.csv"), ModelChoice::fopdt);
    expect_fopdt(model, {1, 10, 2}, {1e-4, 1e-4, 1e-4});
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_EQ(model.warnings.front().code, "load-disturbance");
    EXPECT_THAT(model.warnings.front().detail, ::testing::HasSubstr("0.15 of u"));
    EXPECT_THAT(model.warnings.front().detail, ::testing::HasSubstr("t = 10"));
}

TEST(RecordedTests, RelayTestsOfAFirstOrderPlantAreRecoveredAsWellAsTheyWereRecorded) {
    expect_fopdt(identified(read_record("relay_ex1_unbiased.csv")), {1, 10, 2}, {1e-4, 1e-4, 1e-4});
    expect_fopdt(identified(read_record("relay_ex1_truncated.csv")), {1, 10, 2}, {1e-4, 1e-4, 1e-4});
    expect_fopdt(identified(read_record("relay_ex1_biased_noise.csv")), {1, 10, 2}, {0.05, 0.05, 0.02});
    expect_fopdt(identified(read_record("relay_ex1_biased_missing.csv")), {1, 10, 2}, {0.02, 0.02, 0.01});
    expect_fopdt(identified(read_record("relay_ex1_biased_nonuniform.csv")), {1, 10, 2}, {0.06, 0.06, 0.05});
}

TEST(RecordedTests, TooFewCyclesAreNamedByTheFormulasAndTheFit) {
    const Record record = read_record("relay_ex1_truncated.csv");
    IdentifyOptions options;
    options.method = IdentifyMethod::relay_fourier;
    const auto formulas = identify(record, options, {});
    ASSERT_FALSE(formulas);
    EXPECT_EQ(formulas.error().kind, ErrorKind::not_identifiable);
    EXPECT_THAT(formulas.error().message, ::testing::HasSubstr("two whole ones"));
    const IdentifiedModel fitted = identified(record);
    ASSERT_FALSE(fitted.warnings.empty());
    EXPECT_FALSE(fitted.limit_cycle);
}

TEST(RecordedTests, AFirstOrderModelOfAnotherPlantIsHeldToWhatTheRelayShowed) {
    const IdentifiedModel model = identified(read_record("relay_ex2_biased.csv"), ModelChoice::fopdt);
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_EQ(model.warnings.front().code, "structure-mismatch");
    // The oscillation at Pu = 14.4, and the static gain.
    const auto found = *LinearPlant::make(model.plant);
    const auto plant = *LinearPlant::make(TransferFunction{.num = {-1, 1}, .den = {1, 5, 10, 10, 5, 1}, .L = 1});
    const std::complex<double> s(0, 2 * 3.14159265358979 / 14.4);
    EXPECT_LT(std::abs(found.at(s) - plant.at(s)), 2e-3 * std::abs(plant.at(s)));
    EXPECT_NEAR(found.low_frequency_gain(), 1, 2e-3);
}

TEST(RecordedTests, AnUnbiasedTestOfAnotherPlantLeavesTheStaticGainUnknown) {
    const IdentifiedModel model = identified(read_record("relay_ex3_unbiased.csv"), ModelChoice::fopdt);
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_EQ(model.warnings.front().code, "structure-mismatch");
    EXPECT_THAT(model.warnings.front().detail, ::testing::HasSubstr("static gain is unknown"));
    const auto found = *LinearPlant::make(model.plant);
    const auto plant = *LinearPlant::make(Sopdt{.K = 1, .T1 = 20, .T2 = 2, .L = 1});
    const std::complex<double> s(0, 2 * 3.14159265358979 / 26.2);
    EXPECT_LT(std::abs(found.at(s) - plant.at(s)), 2e-3 * std::abs(plant.at(s)));
}

TEST(RecordedTests, UltimatePointIsThePlants) {
    // L w + atan(10 w) = pi with L = 2: w = 0.84433, Ku = sqrt(1 + (10 w)^2).
    const IdentifiedModel model = identified(read_record("relay_ex1_unbiased.csv"));
    ASSERT_TRUE(model.ultimate_point);
    EXPECT_NEAR(model.ultimate_point->Pu, 2 * 3.14159265358979 / 0.844335, 1e-3);
    EXPECT_NEAR(model.ultimate_point->Ku, std::hypot(1.0, 8.44335), 1e-3);
}

TEST(RecordedTests, LabKitReaches97Point2PercentWithFopdtAndMoreWithAuto) {
    const Record record = read_record("tclab-step.csv", "Time", "Q1", "T1");
    const IdentifiedModel simple = identified(record, ModelChoice::fopdt);
    EXPECT_GE(simple.fit_percent, 97.2);
    const IdentifiedModel chosen = identified(record);
    EXPECT_GE(chosen.fit_percent, simple.fit_percent);
    EXPECT_TRUE(std::holds_alternative<Fopdt>(chosen.plant) || std::holds_alternative<Sopdt>(chosen.plant))
        << chosen.choice_reason;
    EXPECT_EQ(chosen.data_quality.steps, 1);
    EXPECT_EQ(chosen.data_quality.samples, 801);
    EXPECT_NEAR(chosen.data_quality.quantisation, 0.322, 0.001);
}

}  // namespace
}  // namespace tunewright
