// The uncertainty that a record leaves: the band that it excited, and controllers on its confidence region.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/evaluation/evaluate.h"
#include "engine/identification/fit/excited_band.h"
#include "engine/request/identified_region.h"
#include "engine/request/tune.h"

namespace tunewright {
namespace {

Excitation step_test(double noise) {
    Excitation excitation{{}, {}, 0, 0.5, noise};
    for (int i = 0; i < 400; ++i) {
        excitation.t.push_back(0.5 * i);
        excitation.u.push_back(i < 20 ? 0 : 1);
    }
    return excitation;
}

TEST(ExcitedBand, OfAStepIsWhereItsAnswerMeetsTheNoise) {
    // |P U| = |2/(10 j w + 1)|/w reaches sqrt(0.01^2 0.5 199.5) = 0.0999: w = 1.411 by solving 4/((100 w^2 + 1) w^2) =
    // 0.009975.
    const auto band = excited_band(step_test(0.01), Fopdt{.K = 2, .T = 10, .L = 3});
    ASSERT_TRUE(band.has_value());
    const double alone = std::sqrt((-1 + std::sqrt(1 + 4 * 100 * 4 / 0.009975)) / 200);
    EXPECT_NEAR(alone, 1.413, 1e-3);
    // Frequencies within 15 % of an excited one count too; the end is found to 2 %.
    EXPECT_NEAR(band->omega_high / (1.15 * alone), 0.99, 0.011);
    EXPECT_NEAR(band->omega_low, 2 * M_PI / 199.5, 1e-12);
}

TEST(ExcitedBand, AStepAtTheFirstSampleCountsAsMuch) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    Excitation early = step_test(0.01);
    for (double& u : early.u) u = 5;
    EXPECT_FALSE([&] {
        Excitation resting = early;
        resting.u_rest = 5;
        return excited_band(resting, plant).has_value();
    }());
    early.u_rest = 4;
    ASSERT_TRUE(excited_band(early, plant).has_value());
    EXPECT_NEAR(excited_band(early, plant)->omega_high, excited_band(step_test(0.01), plant)->omega_high, 1e-9);
}

TEST(ExcitedBand, MoreNoiseNarrowsItAndSamplingBoundsIt) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    double last = INFINITY;
    for (const double noise : {1e-4, 1e-3, 1e-2, 1e-1}) {
        const auto band = excited_band(step_test(noise), plant);
        ASSERT_TRUE(band.has_value());
        EXPECT_LT(band->omega_high, last);
        last = band->omega_high;
    }
    EXPECT_DOUBLE_EQ(excited_band(step_test(0), plant)->omega_high, M_PI / 0.5);
    EXPECT_FALSE(excited_band(step_test(1e6), plant).has_value());
}

Record noisy_step(double noise, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, noise);
    Record record;
    for (int i = 0; i < 400; ++i) {
        const double t = 0.5 * i, since = t - 10 - 3;
        record.t.push_back(t);
        record.u.push_back(t < 10 ? 0 : 1);
        record.y.push_back((since > 0 ? 2 * (1 - std::exp(-since / 10)) : 0) + normal(random));
    }
    return record;
}

TuningResult tuned(double noise, bool over_region) {
    TuningRequest request;
    request.record = noisy_step(noise, 1);
    request.identify.model = ModelChoice::fopdt;
    request.evaluate.points = 0;
    request.identified_region = over_region ? IdentifiedRegion::held : IdentifiedRegion::unused;
    auto result = tune(request, {});
    EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
    return result ? std::move(*result) : TuningResult{};
}

/// A step test with a plant and noise drawn from `seed`.
Record drawn_step(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<> any(0, 1);
    const double K = 0.3 + 3 * any(random), T = 3 + 27 * any(random), L = 0.5 + 6 * any(random);
    const double noise = (0.01 + 0.1 * any(random)) * K * 5;
    Record record;
    for (int i = 0; i < 200; ++i) {
        const double since = i - 20 - L;
        record.t.push_back(i);
        record.u.push_back(i < 20 ? 0 : 5);
        record.y.push_back((since > 0 ? 5 * K * (1 - std::exp(-since / T)) : 0) + noise * normal(random));
    }
    return record;
}

/// In the form for a client: to the last digit, also if the uncertainty of the structure has widened it.
TEST(IdentifiedModelCovariance, IsSymmetricToTheLastBit) {
    int widened = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        const auto model = identify(drawn_step(seed), {}, {});
        ASSERT_TRUE(model) << model.error().message;
        widened += model->alternatives.empty() ? 0 : 1;
        const auto& rows = model->covariance.matrix;
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) EXPECT_EQ(rows[i][k], rows[k][i]) << "seed " << seed;
    }
    EXPECT_GT(widened, 5) << "else nothing is added to it";
}

TEST(IdentifiedRegion, RobustHoldsItsLimitOnAllOfItWhereAsked) {
    const auto plain = tuned(0.1, false);
    ASSERT_TRUE(plain.model);
    ASSERT_FALSE(plain.model->covariance.names.empty());
    const auto held = tuned(0.1, true);
    ASSERT_TRUE(held.model);
    const auto &nominal = *plain.controllers[0].evaluation, &safe = *held.controllers[0].evaluation;
    EXPECT_EQ(safe.region->stable_fraction, 1);
    EXPECT_LE(*safe.region->worst_Ms, 1.4 * (1 + 1e-4));
    EXPECT_GT(*nominal.region->worst_Ms, 1.42);
    EXPECT_LT(*safe.robustness.Ms, 1.4);
    EXPECT_GT(*safe.performance.load.IAE, *nominal.performance.load.IAE);
    const auto coded = [](const Warning& w) { return w.code == "above-limit-in-region"; };
    EXPECT_TRUE(std::ranges::any_of(nominal.warnings, coded));
    EXPECT_FALSE(std::ranges::any_of(safe.warnings, coded));
    EXPECT_EQ(*plain.model->region->worst_Ms, *nominal.region->worst_Ms);
    // Points of the test's own inside the ellipsoid.
    const auto family = identified_region(*held.model);
    ASSERT_TRUE(family.has_value());
    const PlantRegion* region = family->regions.data();
    EvaluateOptions without_traces;
    without_traces.points = 0;
    for (auto z : region->spread(100)) {
        for (double& x : z) x = -x;
        const auto inside = evaluate(region->at(z), safe.controller, without_traces);
        EXPECT_LE(*inside->robustness.Ms, 1.4 * (1 + 1e-4));
    }
}

TEST(IdentifiedRegion, ACrossoverBeyondTheExcitedBandIsWarnedOf) {
    const auto coded = [](const Warning& w) { return w.code == "beyond-excited-band"; };
    const auto quiet = tuned(0.001, false), loud = tuned(0.3, false);
    EXPECT_FALSE(std::ranges::any_of(quiet.controllers[0].evaluation->warnings, coded));
    EXPECT_TRUE(std::ranges::any_of(loud.controllers[0].evaluation->warnings, coded))
        << loud.model->excited_band->omega_high << " " << *loud.controllers[0].evaluation->robustness.phase_crossover;
}

/// Residual sum of squares of a first-order plant, with a fitted offset; the step comes at t = 10.
double left_by(const Fopdt& plant, const Record& record) {
    std::vector<double> rest;
    double mean = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        const double since = record.t[i] - 10 - plant.L;
        rest.push_back(record.y[i] - (since > 0 ? plant.K * -std::expm1(-since / plant.T) : 0));
        mean += rest.back() / static_cast<double>(record.t.size());
    }
    double sum = 0;
    for (const double e : rest) sum += (e - mean) * (e - mean);
    return sum;
}

TEST(IdentifiedRegion, HoldsNoPlantThatTheRecordExcludes) {
    // A step that ends before y has settled: gain and lag are uncertain together, along a curve that no ellipse
    // follows.
    int excluded = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal(0, 0.02);
        Record record;
        for (int i = 0; i < 200; ++i) {
            const double t = 0.25 * i, since = t - 10 - 3;
            record.t.push_back(t);
            record.u.push_back(t < 10 ? 0 : 1);
            record.y.push_back((since > 0 ? 2 * -std::expm1(-since / 50) : 0) + normal(random));
        }
        IdentifyOptions options;
        options.model = ModelChoice::fopdt;
        const auto model = identify(record, options, {});
        ASSERT_TRUE(model);
        const auto family = identified_region(*model);
        ASSERT_TRUE(family);
        const PlantRegion& region = family->regions.front();
        const auto ellipsoid =
            PlantRegion::of_covariance(model->plant, model->covariance.names, model->covariance.matrix);
        const double min = left_by(std::get<Fopdt>(model->plant), record);
        const auto growth = [&](const PlantRegion& in, PlantRegion::Point z, double share) {
            for (double& x : z) x *= share;
            return left_by(std::get<Fopdt>(in.at(z)), record) - min;
        };
        for (const auto& z : region.ends()) {
            // The curvature of the sum of squares, which the covariance represents.
            const double curvature = 0.5 * (growth(*ellipsoid, z, 0.02) + growth(*ellipsoid, z, -0.02)) / (0.02 * 0.02);
            EXPECT_LT(growth(region, z, 1), 1.7 * curvature + 1e-3 * min) << seed;
            excluded += growth(*ellipsoid, z, 1) > 1.7 * curvature;
        }
    }
    EXPECT_GT(excluded, 0) << "no ellipsoid here needs a cut";
}

TEST(PlantRegions, ACutMovesEachEndToItsShare) {
    auto region = PlantRegion::of_covariance(Fopdt{.K = 2, .T = 10, .L = 3}, {"K", "T"}, {{0.04, 0}, {0, 1}});
    ASSERT_TRUE(region);
    const auto ends = region->ends();
    std::vector<double> shares, K;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        shares.push_back(1 - 0.1 * static_cast<double>(i));
        K.push_back(parameter(region->at(ends[i]), "K"));
    }
    region->cut(shares);
    for (std::size_t i = 0; i < ends.size(); ++i)
        EXPECT_NEAR(parameter(region->at(ends[i]), "K") - 2, shares[i] * (K[i] - 2), 1e-6);
    EXPECT_EQ(parameter(region->at({0, 0}), "K"), 2);
}

}  // namespace
}  // namespace tunewright
