// A controller that is switched on moves u once, without feedback: the plant is identified from it within its errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "engine/identification/identify.h"
#include "engine/plant/linear/linear_plant.h"
#include "tests/long_or_quick.h"
#include "tests/records/switched_on_records.h"

namespace tunewright {
namespace {

using testing::ColdStart;
using testing::LoopPlant;
using testing::random_cold_start;

std::complex<double> true_response(const LoopPlant& p, double w) {
    const std::complex<double> s(0, w);
    return p.K * std::exp(-p.L * s) / ((1.0 + p.T1 * s) * (1.0 + p.T2 * s));
}

/// Relative error of the frequency response where the plant's phase is about -60 degrees.
double miss(const Plant& plant, const LoopPlant& truth) {
    const double w = 1 / (0.3 * truth.T1 + truth.T2 + truth.L);
    const auto found = LinearPlant::make(plant)->at({0, w}), right = true_response(truth, w);
    return std::abs(found - right) / std::abs(right);
}

/// Expects a response within a tenth of the true one, and K and L within three standard errors.
void expect_right(const Record& record, const LoopPlant& truth, const char* which, bool in_loop = true) {
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model) << which << ": " << model.error().message;
    if (in_loop) {
        ASSERT_TRUE(model->data_quality.closed_loop) << which;
        EXPECT_EQ(model->data_quality.closed_loop->used, LoopExcitation::switched_on) << which;
    }
    EXPECT_LT(miss(model->plant, truth), 0.1) << which;
    const double K = std::abs(LinearPlant::make(model->plant)->at({0, 1e-4 / truth.T1}));
    EXPECT_NEAR(K, std::abs(truth.K), 3 * model->standard_errors.at("K") + 0.01 * std::abs(truth.K)) << which;
}

TEST(SwitchedOn, AnOvensLogTellsThePlant) {
    ColdStart oven;
    oven.y_grid = 0.25;
    oven.u_grid = 1;
    expect_right(oven.record(), oven.plant, "with its set point");
    oven.with_r = false;
    expect_right(oven.record(), oven.plant, "without");
}

/// While u is held at its limit there is no feedback; if it were taken for a test by hand that ended there, the record
/// would be cut short.
TEST(SwitchedOn, AtTheEndOfUAllRowsCount) {
    ColdStart oven;
    for (const int row : {20, 30}) {
        oven.on_row = row;
        expect_right(oven.record(), oven.plant, "saturated", false);
    }
}

TEST(SwitchedOn, ACoolersLogTellsANegativeGain) {
    ColdStart cooler;
    cooler.plant.K = -0.5, cooler.Kp = -4, cooler.y0 = 25, cooler.r = 5;
    expect_right(cooler.record(), cooler.plant, "cooler");
}

TEST(SwitchedOn, FromTheFirstRowOnTheLevelOfRestIsEstimated) {
    ColdStart oven;
    oven.on_row = 0;
    oven.Td = 10;
    const auto model = identify(oven.record(), {}, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_LT(miss(model->plant, oven.plant), 0.1);
}

bool warns_of_gain(const IdentifiedModel& model) {
    return std::any_of(model.warnings.begin(), model.warnings.end(), [](const Warning& warning) {
        return warning.detail.find("gain") != std::string::npos || warning.detail.find("K = ") != std::string::npos;
    });
}

/// With u moved in or before the first row, from 0 or from `rest`, the level of rest is not in the record. Every wrong
/// model then has a warning; from 0, nearly all models are right.
TEST(SwitchedOn, InTheFirstRowNothingIsWrongInSilence) {
    const auto seeds = static_cast<unsigned>(long_or_quick(12, 5));
    for (const double rest : {0.0, 0.5}) {
        int right = 0, answers = 0;
        for (unsigned seed = 36; seed < 36 + seeds; ++seed) {
            ColdStart cold = random_cold_start(seed);
            cold.on_row = 0;
            Record record = cold.record();
            for (double& u : record.u) u += rest * (cold.r - cold.y0) / cold.plant.K;
            const auto model = identify(record, {}, {});
            if (!model) continue;
            ++answers;
            const auto plant = LinearPlant::make(model->plant);
            const double off = std::abs(plant->low_frequency_gain() - cold.plant.K), size = std::abs(cold.plant.K);
            const bool gain =
                plant->integrators() == 0 && (off < 0.1 * size || off < 3 * model->standard_errors.at("K"));
            right += gain && miss(model->plant, cold.plant) < 0.15;
            EXPECT_TRUE(gain || warns_of_gain(*model)) << seed << " from " << rest << ": " << model->choice_reason;
        }
        if (rest == 0) {
            EXPECT_GE(right, 0.9 * answers);
        }
    }
}

/// A usual trim of a file: the heater is already on in the first row.
TEST(SwitchedOn, AnOpenLoopRecordThatBeginsWithUMovedIsTakenToComeFromOff) {
    testing::PlantRun run({1.2, 200, 20, 10, false}, 1);
    Record record;
    double y = 20;
    for (int t = 0; t < 1500; ++t) {
        record.t.push_back(t);
        record.u.push_back(t < 700 ? 50 : 70);
        record.y.push_back(std::round(50 * y) / 50);
        y = 20 + run.advance(record.u.back());
    }
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_NEAR(LinearPlant::make(model->plant)->low_frequency_gain(), 1.2, 0.06);
    EXPECT_LT(miss(model->plant, {1.2, 200, 20, 10, false}), 0.1);
}

/// Right: K within a tenth or three of its errors, and the response within 15 %.
TEST(SwitchedOn, MadeColdStartsAreRightWithinTheirErrors) {
    int right = 0, answers = 0;
    std::string wrong;
    constexpr unsigned kSeeds = 40;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        const ColdStart cold = random_cold_start(seed);
        const auto model = identify(cold.record(), {}, {});
        if (!model) continue;
        ++answers;
        const double K = std::abs(LinearPlant::make(model->plant)->at({0, 1e-4 / cold.plant.T1}));
        const double off = std::abs(K - std::abs(cold.plant.K));
        const bool gain = off < 0.1 * std::abs(cold.plant.K) || off < 3 * model->standard_errors.at("K");
        if (gain && miss(model->plant, cold.plant) < 0.15)
            ++right;
        else
            wrong += " " + std::to_string(seed);
    }
    EXPECT_GE(answers, 0.9 * kSeeds);
    EXPECT_GE(right, 0.93 * answers) << "wrong:" << wrong;
}

}  // namespace
}  // namespace tunewright
