// Moves of u between rows, estimated with the model: stated errors that are neither too small nor too large.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/evaluation/evaluate.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/request/tune.h"
#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kK = 640, kT1 = 150, kT2 = 6, kL = 1.5;

/// A heater's duty switched on and off between rows one second apart: heat-up, then a cycle about a set point.
Steps heater_moves(unsigned seed) {
    std::mt19937 bits(seed);
    const auto part = [&] { return std::uniform_real_distribution<double>(0, 1)(bits); };
    Steps moves = {{10 + part(), 1.0}};
    double time = 56 + 3 * part();
    for (int k = 0; k < 12; ++k) {
        moves.emplace_back(time, k % 2 == 0 ? 0.0 : 1.0);
        time += k % 2 == 0 ? 22 + 5 * part() : 9 + 3 * part();
    }
    return moves;
}

Record heater_record(const Steps& moves, unsigned seed) {
    Record record = simulate(even_times(300, 1), 0, 22, moves, two_lags(kK, kT1, kT2, kL));
    add_noise(record, 0.07, seed);
    for (double& y : record.y) y = std::round(10 * y) / 10;
    return record;
}

TEST(MoveTimes, StatedErrorsAreAsLargeAsTheErrors) {
    constexpr int kSeeds = 40;
    int sharp = 0;
    double K = 0, T1 = 0;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
        const IdentifiedModel model = identified(heater_record(heater_moves(seed), seed), ModelChoice::sopdt);
        EXPECT_THAT(model.data_quality.notes, Contains(HasSubstr("13 change(s) of u happened between rows"))) << seed;
        const auto plant = plant_as<Sopdt>(model);
        // From the Cramer-Rao bound of the same test, with times equally likely anywhere in their rows: 0.76 and 0.24.
        sharp += model.standard_errors.at("K") < 0.01 * kK && model.standard_errors.at("T1") < 0.01 * kT1;
        EXPECT_LT(model.standard_errors.at("K"), 0.05 * kK) << seed;
        EXPECT_LT(model.standard_errors.at("T1"), 0.05 * kT1) << seed;
        EXPECT_NEAR(plant.L, kL, 3 * model.standard_errors.at("L")) << seed;
        K += std::pow((plant.K - kK) / model.standard_errors.at("K"), 2) / kSeeds;
        T1 += std::pow((plant.T1 - kT1) / model.standard_errors.at("T1"), 2) / kSeeds;
    }
    // The other records do not distinguish their noise from a load that is a random walk.
    EXPECT_GE(sharp, 0.9 * kSeeds);
    // Mean squares of 40 normal values: 1 with a standard deviation of 0.22. Errors stated too large by a factor of two
    // give 0.25.
    for (const double mean_square : {K, T1}) {
        EXPECT_GT(mean_square, 0.3);
        EXPECT_LT(mean_square, 1.6);
    }
}

TEST(MoveTimes, ADesignIsAsGoodAsTheRecordAllows) {
    const Sopdt truth{kK, kT1, kT2, kL};
    TuningRequest of_truth;
    of_truth.subject = std::get<AnalysedPlant>(AnalysedPlant::make(PlantModel(Plant(truth))));
    of_truth.evaluate.points = 0;
    const auto best = tune(of_truth, {});
    ASSERT_TRUE(best);
    const double min = *best->controllers.front().evaluation->performance.load.IAE;
    for (unsigned seed = 0; seed < 3; ++seed) {
        TuningRequest request;
        request.record = heater_record(heater_moves(seed), seed);
        request.evaluate.points = 0;
        const auto result = tune(request, {});
        ASSERT_TRUE(result);
        const auto judged = evaluate(PlantModel(Plant(truth)), result->controllers.front().evaluation->controller, {});
        ASSERT_TRUE(judged);
        EXPECT_LE(*judged->robustness.Ms, 1.5) << seed;
        EXPECT_LE(*judged->performance.load.IAE, 3 * min) << seed;
    }
}

TEST(MoveTimes, MovesThatFallOnTheirRowsStayThere) {
    Steps moves = heater_moves(3);
    for (auto& [time, level] : moves) time = std::ceil(time);
    const IdentifiedModel model = identified(heater_record(moves, 3), ModelChoice::sopdt);
    EXPECT_THAT(model.data_quality.notes, ::testing::Not(Contains(HasSubstr("between rows"))));
    EXPECT_NEAR(plant_as<Sopdt>(model).L, kL, 3 * model.standard_errors.at("L"));
    EXPECT_LT(model.standard_errors.at("L"), 0.1);
}

TEST(MoveTimes, ALoggerAtAnotherPhaseOfTheSameClockLeavesTheDeadTimeOpenByARow) {
    for (const double phase : {0.1, 0.5, 0.9}) {
        Steps moves = heater_moves(4);
        for (auto& [time, level] : moves) time = std::floor(time) + phase;
        const IdentifiedModel model = identified(heater_record(moves, 4), ModelChoice::sopdt);
        const auto plant = plant_as<Sopdt>(model);
        EXPECT_NEAR(plant.K, kK, 3 * model.standard_errors.at("K")) << phase;
        EXPECT_NEAR(plant.L, kL, 1.0) << phase;
    }
}

}  // namespace
}  // namespace tunewright
