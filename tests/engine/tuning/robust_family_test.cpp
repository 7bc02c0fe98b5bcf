// Robust design for more than one plant: the limits hold on every one of them, checked by evaluations that are
// independent of the search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/evaluation/evaluate.h"
#include "engine/request/tune.h"
#include "engine/tuning/registry.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

/// Ranges of K, T and L.
Uncertainty ranges(std::optional<FactorRange> K, std::optional<FactorRange> T, std::optional<FactorRange> L) {
    Uncertainty uncertainty;
    uncertainty.K = K;
    uncertainty.T = T;
    uncertainty.L = L;
    return uncertainty;
}

TuningEntry robust_entry(const PlantModel& plant,
                         std::initializer_list<std::pair<const char*, OptionValue>> options = {}) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.evaluate.points = 0;
    for (const auto& [path, value] : options) request.tune[0].options.set(path, value);
    auto result = tune(request, {});
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return result ? result->controllers.at(0) : TuningEntry{};
}

const IdealPid& pid_of(const TuningEntry& entry) { return std::get<IdealPid>(entry.evaluation->controller); }

/// The larger of Ms and Mt of one plant with this controller; infinite if unstable.
double larger_peak(const Plant& plant, const IdealPid& pid) {
    EvaluateOptions options;
    options.points = 0;
    const auto alone = evaluate(plant, pid, options);
    EXPECT_TRUE(alone.has_value());
    if (!alone || !alone->robustness.stable) return INFINITY;
    return std::max(*alone->robustness.Ms, *alone->robustness.Mt);
}

TEST(RobustFamily, ASetOfOnePlantIsThePlainDesign) {
    const Plant plant = Sopdt{.K = 2, .T1 = 8, .T2 = 2, .L = 1};
    const auto plain = robust_entry(plant), set = robust_entry(PlantSet{{plant}});
    ASSERT_TRUE(plain.evaluation && set.evaluation);
    EXPECT_EQ(pid_of(plain).Kp, pid_of(set).Kp);
    EXPECT_EQ(pid_of(plain).Ti, pid_of(set).Ti);
    EXPECT_FALSE(set.evaluation->region);
}

TEST(RobustFamily, LimitsHoldOnEveryPlantOfASetWithEverySearch) {
    const PlantSet set{
        {Fopdt{.K = 2, .T = 10, .L = 3}, Fopdt{.K = 2.5, .T = 8, .L = 4}, Sopdt{.K = 1, .T1 = 9, .T2 = 3, .L = 2}}};
    double min = INFINITY;
    for (const std::string search : {"fast", "nelder_mead", "grid"}) {
        const auto entry = robust_entry(set, {{"search", search}, {"controller", std::string("PI")}});
        ASSERT_TRUE(entry.evaluation) << search;
        for (const auto& plant : set.plants) EXPECT_LE(larger_peak(plant, pid_of(entry)), 1.4 * (1 + 3e-5)) << search;
        EXPECT_EQ(entry.evaluation->region->stable_fraction, 1);
        EXPECT_LE(*entry.evaluation->region->worst_Ms, 1.4 * (1 + 3e-5));
        const double IAE = *entry.evaluation->performance.load.IAE;
        min = std::min(min, IAE);
        EXPECT_LT(IAE, min * 1.02) << search;
    }
}

TEST(RobustFamily, AConstraintOfOneCircleHoldsOnAllPlantsToo) {
    const PlantSet set{{Fopdt{.K = 1, .T = 5, .L = 1}, Fopdt{.K = 1.5, .T = 5, .L = 1.2}}};
    const auto entry = robust_entry(set, {{"constraint", std::string("m_circle")}, {"Mks", 8.0}});
    ASSERT_TRUE(entry.evaluation);
    EvaluateOptions options;
    options.points = 0;
    for (const auto& plant : set.plants) {
        EXPECT_LE(larger_peak(plant, pid_of(entry)), 1.4 * (1 + 3e-5));
        EXPECT_LE(*evaluate(plant, pid_of(entry), options)->robustness.Mks, 8.0 * (1 + 3e-5));
    }
}

TEST(RobustFamily, LimitsHoldEverywhereInsideTheRanges) {
    const Plant plants[] = {
        Fopdt{.K = 2,
              .T = 10,
              .L = 3,
              .uncertainty = ranges(FactorRange{0.8, 1.2}, FactorRange{0.7, 1.1}, FactorRange{0.9, 1.2})},
        Ipdt{.K = 0.1, .L = 2, .uncertainty = ranges(FactorRange{0.7, 1.3}, std::nullopt, FactorRange{0.5, 1.5})},
        // A resonance whose peak moves through the crossover: the corners alone are not sufficient.
        OscillatorySopdt{.K = 1,
                         .T = 1,
                         .zeta = 0.15,
                         .L = 0.3,
                         .uncertainty = ranges(std::nullopt, FactorRange{0.7, 1.4}, std::nullopt)},
    };
    for (const Plant& plant : plants) {
        const auto entry = robust_entry(plant);
        ASSERT_TRUE(entry.evaluation);
        EXPECT_EQ(entry.evaluation->region->stable_fraction, 1);
        const auto region = PlantRegion::of_ranges(plant);
        double worst = 0;
        // Points other than the search's: shifted by an irrational step.
        for (const auto& z : region.spread(150)) {
            PlantRegion::Point other = z;
            for (double& x : other) x = std::remainder(x + 0.7548776662, 2.0);
            worst = std::max(worst, larger_peak(region.at(other), pid_of(entry)));
        }
        EXPECT_LE(worst, 1.4 * (1 + 1e-4)) << plant.index();
        EXPECT_LE(*entry.evaluation->region->worst_Ms, 1.4 * (1 + 1e-4)) << plant.index();
    }
}

TEST(RobustFamily, LimitsHoldOverAConfidenceEllipsoid) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto region = PlantRegion::of_covariance(plant, {"K", "T", "L"},
                                                   {{0.01, 0.06, 0.005}, {0.06, 0.64, -0.05}, {0.005, -0.05, 0.04}});
    const auto linear = LinearPlant::make(plant);
    ASSERT_TRUE(region && linear);
    const PlantFamily family{{*region}};
    const auto tuned = find_method("robust")->tune(TuningProblem{plant, *linear, std::nullopt, family}, {}, {});
    ASSERT_TRUE(tuned.has_value());
    EvaluateOptions options;
    options.points = 0;
    const auto judged = evaluate(*AnalysedPlant::of_family(family), tuned->controller, options);
    EXPECT_EQ(judged->region->stable_fraction, 1);
    EXPECT_NEAR(*judged->region->worst_Ms, 1.4, 1.4e-4);
    EXPECT_LT(*judged->robustness.Ms, 1.38);
    for (PlantRegion::Point z : region->spread(150)) {
        for (double& x : z) x = -x;
        EXPECT_LE(larger_peak(region->at(z), tuned->controller), 1.4 * (1 + 1e-4));
    }
}

TEST(RobustFamily, WiderUncertaintyNeverCostsLess) {
    double last = 0;
    for (const double spread : {1.0, 1.05, 1.2, 1.5, 2.0}) {
        Fopdt plant{.K = 1, .T = 4, .L = 1};
        if (spread > 1)
            plant.uncertainty = ranges(FactorRange{1 / spread, spread}, std::nullopt, FactorRange{1 / spread, spread});
        const auto entry = robust_entry(plant);
        ASSERT_TRUE(entry.evaluation) << spread;
        EXPECT_GT(*entry.evaluation->performance.load.IAE, last * (1 - 1e-3)) << spread;
        last = *entry.evaluation->performance.load.IAE;
    }
}

TEST(RobustFamily, ThePlantBetweenTwoOthersCostsNothing) {
    const Fopdt a{.K = 2, .T = 10, .L = 3}, b{.K = 3, .T = 10, .L = 3}, between{.K = 2.5, .T = 10, .L = 3};
    const auto two = robust_entry(PlantSet{{a, b}}), three = robust_entry(PlantSet{{a, b, between}});
    ASSERT_TRUE(two.evaluation && three.evaluation);
    EXPECT_NEAR(*three.evaluation->performance.load.IAE / *two.evaluation->performance.load.IAE, 1, 1e-3);
}

TEST(RobustFamily, PlantsThatNeedGainsOfBothSignsAreRefusedInWords) {
    TuningRequest request;
    request.subject = test::subject_of(PlantSet{{Fopdt{.K = 1, .T = 5, .L = 1}, Fopdt{.K = -1, .T = 5, .L = 1}}});
    const auto result = tune(request, {});
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::no_feasible_controller);
    EXPECT_NE(result.error().message.find("Some of the plants need a positive"), std::string::npos);
}

TEST(RobustFamily, ImpossibleRangesNameTheLimitThatWorks) {
    TuningRequest request;
    request.subject = test::subject_of(
        Fopdt{.K = -1, .T = -10, .L = 1, .uncertainty = ranges(FactorRange{0.5, 2}, std::nullopt, FactorRange{1, 2})});
    request.tune[0].options.set("Ms", 1.4);
    const auto result = tune(request, {});
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::no_feasible_controller);
    EXPECT_NE(result.error().message.find("evaluated plants"), std::string::npos) << result.error().message;
    // The cure works, and a slightly smaller value does not.
    const auto within = [&](double limit) {
        request.tune[0].options.set("Ms", limit);
        request.tune[0].options.set("Mt", limit);
        return tune(request, {}).has_value();
    };
    ASSERT_EQ(result.error().cure.size(), 2u) << result.error().message;
    const double limit = result.error().cure.at("Ms");
    EXPECT_EQ(result.error().cure.at("Mt"), limit);
    EXPECT_TRUE(within(limit));
    EXPECT_FALSE(within(1 + 0.8 * (limit - 1)));
}

TEST(RobustFamily, ARuleIsJudgedOnAllPlantsAndWarnsOfUnstableOnes) {
    TuningRequest request;
    request.subject = test::subject_of(PlantSet{{Fopdt{.K = 1, .T = 10, .L = 1}, Fopdt{.K = 4, .T = 10, .L = 3}}});
    request.tune = {{"simc", {}}};
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    ASSERT_TRUE(result.has_value());
    const auto& evaluation = *result->controllers[0].evaluation;
    EXPECT_TRUE(evaluation.robustness.stable);
    EXPECT_EQ(evaluation.region->stable_fraction, 0.5);
    EXPECT_FALSE(evaluation.region->worst_Ms);
    EXPECT_EQ(std::get<Fopdt>(evaluation.region->worst_plant).K, 4);
    EXPECT_TRUE(
        std::ranges::any_of(evaluation.warnings, [](const Warning& w) { return w.code == "unstable-in-region"; }));
}

}  // namespace
}  // namespace tunewright
