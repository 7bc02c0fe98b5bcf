// The figures of one controller on every plant of a family.
#include "engine/evaluation/robustness_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/evaluate_sampled.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

TEST(FamilyFigures, APeakFarBelowOneIsFoundToo) {
    // A plant without dynamics, P = K, under u = 3 (r - y): S = 1/(1 + 3 K) at every frequency, largest at K = 1.6.
    const Plant plant = Fopdt{2, 0, 0, {.K = FactorRange{0.8, 1.2}}};
    const RegionFigures figures = region_figures(family_of(plant), ParallelPid{3, 0, 0});
    EXPECT_EQ(figures.stable_fraction, 1);
    ASSERT_TRUE(figures.worst_Ms);
    EXPECT_NEAR(*figures.worst_Ms, 1 / (1 + 3 * 1.6), 1e-12);
    EXPECT_NEAR(std::get<Fopdt>(figures.worst_plant).K, 1.6, 1e-12);
}

EvaluateOptions without_traces() {
    EvaluateOptions options;
    options.points = 0;
    return options;
}

// A P controller on K e^(-s)/(10 s + 1), K from 0.8 to 1.2, whose ultimate gain is reached at K = 1.1995: beyond every
// sample, before the corner.
TEST(FamilyFigures, AnUnstableCornerIsNeverToldAsAllStable) {
    double w = 1.6;  // atan(10 w) + w = pi
    for (int i = 0; i < 50; ++i) w = std::numbers::pi - std::atan(10 * w);
    const Plant plant = Fopdt{1, 10, 1, {.K = FactorRange{0.8, 1.2}}};
    const IdealPid pid{.Kp = std::sqrt(1 + 100 * w * w) / 1.1995, .Ti = 1e7};
    const auto evaluation = evaluate(plant, pid, without_traces());
    ASSERT_TRUE(evaluation && evaluation->region);
    EXPECT_TRUE(evaluation->robustness.stable);
    EXPECT_FALSE(evaluation->region->worst_Ms);
    EXPECT_DOUBLE_EQ(evaluation->region->stable_fraction, 128.0 / 129);
    const auto warning = std::ranges::find_if(evaluation->warnings,
                                              [](const Warning& each) { return each.code == "unstable-in-region"; });
    ASSERT_NE(warning, evaluation->warnings.end());
    EXPECT_EQ(warning->detail.find("100 %"), std::string::npos) << warning->detail;
    EXPECT_NE(warning->detail.find("99.2 % of the evaluated plants"), std::string::npos) << warning->detail;
}

// 2,000 plants and one that is unstable: 99.95 % would round to 100 %.
TEST(FamilyFigures, AShareIsNotRoundedToAll) {
    PlantSet set;
    for (int i = 0; i < 2000; ++i) set.plants.emplace_back(Fopdt{1, 10, 1});
    set.plants.emplace_back(Fopdt{100, 10, 1});
    const auto evaluation = evaluate(PlantModel(set), IdealPid{.Kp = 1, .Ti = 10}, without_traces());
    ASSERT_TRUE(evaluation && evaluation->region);
    const auto warning = std::ranges::find_if(evaluation->warnings,
                                              [](const Warning& each) { return each.code == "unstable-in-region"; });
    ASSERT_NE(warning, evaluation->warnings.end());
    EXPECT_EQ(warning->detail.find("100 %"), std::string::npos) << warning->detail;
    EXPECT_NE(warning->detail.find("more than 99.9 %"), std::string::npos) << warning->detail;
}

TEST(FamilyFigures, TheWorstMsOfAProgramIsThatOfItsOwnLoopOnTheWorstPlant) {
    const PlantModel plants(PlantSet{{Fopdt{2, 10, 3}, Fopdt{2.4, 10, 3.6}, Fopdt{1.8, 12, 3}}});
    const IdealPid pid{.Kp = 0.7, .Ti = 6, .Td = 1, .filter = {FilterType::derivative, 0.1}};
    const SampledPid law{.gains = to_parallel(pid), .Ts = 1.5};
    const auto loop = evaluate_sampled(test::subject_of(plants), law, {}, without_traces());
    ASSERT_TRUE(loop && loop->region && loop->region->worst_Ms);
    const PlantModel worst(loop->region->worst_plant);
    const auto alone = evaluate_sampled(test::subject_of(worst), law, {}, without_traces());
    ASSERT_TRUE(alone && alone->robustness.Ms);
    EXPECT_FALSE(alone->region);
    EXPECT_NEAR(*loop->region->worst_Ms, *alone->robustness.Ms, 1e-6);
    EXPECT_GE(*loop->region->worst_Ms, *loop->robustness.Ms - 1e-9);
    const auto ideal = evaluate(plants, pid, without_traces());
    ASSERT_TRUE(ideal && ideal->region);
    EXPECT_GT(*loop->region->worst_Ms, 1.02 * *ideal->region->worst_Ms) << "half a sample acts as dead time";
}

}  // namespace
}  // namespace tunewright
