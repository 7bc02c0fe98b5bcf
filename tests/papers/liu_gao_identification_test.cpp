// Liu and Gao (2008), section 2 and examples 1 to 3: limit cycles and models by their formulas, from event-accurate
// simulated relay tests, compared with an independent computation with machine-precision integrals (the printed table
// has the sampling errors of the authors' simulation; the printed model of example 3 does not solve Eqs. 11 to 13).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "engine/identification/identify.h"
#include "engine/simulation/relay/relay.h"

namespace tunewright {
namespace {

struct Example {
    const char* name;
    Plant plant;
    double u_plus, u_minus;
    double Pu, Au, phi_u, A_alpha;
    double K, T, L;
};

const Plant kSecondOrder = Sopdt{.K = 1, .T1 = 20, .T2 = 2, .L = 1};

std::vector<Example> examples() {
    const Plant first = Fopdt{.K = 1, .T = 10, .L = 2};
    const Plant second = TransferFunction{.num = {-1, 1}, .den = {1, 5, 10, 10, 5, 1}, .L = 1};
    return {
        {"1, unbiased", first, 1, -1, 14.39098, 0.2232584, -2.218852, 0.1704858, 1, 10, 2},
        {"1, biased", first, 1.3, -0.7, 15.56731, 0.2404901, -2.135154, 0.1817588, 1, 10, 2},
        {"2, biased", second, 1.3, -0.7, 14.3658, 0.7046321, -2.911185, 0.3895188, 1, 2.302419, 4.852385},
        {"3, unbiased", kSecondOrder, 1, -1, 26.05589, 0.1828708, -2.056866, 0.1231808, 1.181675, 26.47377, 2.660041}};
}

Record recorded(const Plant& plant, double u_plus, double u_minus, double interval) {
    RelaySettings settings;
    settings.u_plus = u_plus;
    settings.u_minus = u_minus;
    settings.hysteresis = 0.2;
    settings.cycles = 12;
    settings.record_interval = interval;
    const auto experiment = simulate_relay(plant, settings, {});
    EXPECT_TRUE(experiment) << experiment.error().message;
    Record record;
    record.t = experiment->record.t;
    record.u = experiment->record.u;
    record.y = experiment->record.y;
    record.kind = RecordKind::relay;
    record.u0 = 0;
    record.y0 = 0;
    return record;
}

IdentifiedModel by_formulas(const Record& record, double shift) {
    IdentifyOptions options;
    options.model = ModelChoice::fopdt;
    options.method = IdentifyMethod::relay_fourier;
    options.shift = shift;
    auto model = identify(record, options, {});
    EXPECT_TRUE(model) << (model ? "" : model.error().message);
    return model ? *model : IdentifiedModel{};
}

TEST(LiuGaoIdentification, LimitCyclesWithin1e5AndModelsWithin1e3) {
    for (const Example& e : examples()) {
        const IdentifiedModel model = by_formulas(recorded(e.plant, e.u_plus, e.u_minus, 0.01), 0.1);
        ASSERT_TRUE(model.limit_cycle) << e.name;
        const LimitCycle& cycle = *model.limit_cycle;
        EXPECT_NEAR(cycle.Pu, e.Pu, 1e-5 * e.Pu) << e.name;
        EXPECT_NEAR(cycle.Au, e.Au, 1e-5 * e.Au) << e.name;
        EXPECT_NEAR(cycle.phi_u, e.phi_u, 1e-5) << e.name;
        EXPECT_NEAR(cycle.shift->A, e.A_alpha, 1e-5 * e.A_alpha) << e.name;
        ASSERT_TRUE(std::holds_alternative<Fopdt>(model.plant)) << e.name;
        const auto& plant = std::get<Fopdt>(model.plant);
        EXPECT_NEAR(plant.K, e.K, 1e-3 * e.K) << e.name;
        EXPECT_NEAR(plant.T, e.T, 1e-3 * e.T) << e.name;
        EXPECT_NEAR(plant.L, e.L, 1e-3 * e.L) << e.name;
    }
}

TEST(LiuGaoIdentification, PrintedModelsOfExamplesOneAndTwoWithinTheirSampling) {
    const auto unbiased = std::get<Fopdt>(by_formulas(recorded(examples()[0].plant, 1, -1, 0.01), 0.1).plant);
    EXPECT_NEAR(unbiased.K, 1.0048, 0.007 * 1.0048);
    EXPECT_NEAR(unbiased.T, 10.049, 0.007 * 10.049);
    EXPECT_NEAR(unbiased.L, 2.0024, 0.007 * 2.0024);
    const auto biased = std::get<Fopdt>(by_formulas(recorded(examples()[2].plant, 1.3, -0.7, 0.01), 0.1).plant);
    EXPECT_NEAR(biased.K, 1.0001, 1e-3);
    EXPECT_NEAR(biased.T, 2.3017, 2e-3 * 2.3017);
    EXPECT_NEAR(biased.L, 4.8578, 2e-3 * 4.8578);
}

// Eqs. 11 to 13 on a plant that is not first order: the resulting gain depends on the shift.
TEST(LiuGaoIdentification, GainOfAnUnbiasedTestOfASecondOrderPlantFollowsTheShift) {
    const Record record = recorded(kSecondOrder, 1, -1, 0.01);
    struct Root {
        double shift, K, T, L;
    };
    for (const Root& root : {Root{0.02, 1.074548, 24.01184, 2.724883}, Root{0.1, 1.181675, 26.47377, 2.660041},
                             Root{0.3, 1.682976, 37.93852, 2.467185}}) {
        const IdentifiedModel model = by_formulas(record, root.shift);
        const auto& plant = std::get<Fopdt>(model.plant);
        EXPECT_NEAR(plant.K, root.K, 1e-3 * root.K) << root.shift;
        EXPECT_NEAR(plant.T, root.T, 1e-3 * root.T) << root.shift;
        EXPECT_NEAR(plant.L, root.L, 1e-3 * root.L) << root.shift;
        ASSERT_FALSE(model.warnings.empty());
        EXPECT_EQ(model.warnings.front().code, "structure-mismatch");
    }
}

TEST(LiuGaoIdentification, MeasuredFrequencyPointsLieOnThePlant) {
    const IdentifiedModel model = by_formulas(recorded(kSecondOrder, 1, -1, 0.01), 0.1);
    const auto plant = *LinearPlant::make(kSecondOrder);
    ASSERT_GE(model.frequency_points.size(), 3u);
    for (const FrequencyPoint& point : model.frequency_points) {
        const auto exact = plant.at({0, point.omega});
        const double allowed = 4 * point.std + 1e-4 * std::abs(exact) + 1e-6;
        EXPECT_NEAR(point.re, exact.real(), allowed) << point.omega;
        EXPECT_NEAR(point.im, exact.imag(), allowed) << point.omega;
    }
}

// Over many time constants the free run of an unstable model is arbitrary: the record's beginning must be sufficient.
TEST(LiuGaoIdentification, LongRecordOfAnUnstablePlantIsReadFromItsBeginning) {
    RelaySettings settings;
    settings.hysteresis = 0.1;
    settings.noise_std = 0.005;
    settings.relay_sample_time = 0.02;
    settings.cycles = 25;
    const auto experiment = simulate_relay(Fopdt{.K = -1, .T = -1, .L = 0.3}, settings, {});
    ASSERT_TRUE(experiment);
    Record record;
    record.t = experiment->record.t;
    record.u = experiment->record.u;
    record.y = experiment->record.y;
    ASSERT_GT(record.t.back(), 40);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    ASSERT_TRUE(std::holds_alternative<Fopdt>(model->plant)) << model->choice_reason;
    const auto& plant = std::get<Fopdt>(model->plant);
    EXPECT_NEAR(plant.K, -1, 0.06);
    EXPECT_NEAR(plant.T, -1, 0.06);
    EXPECT_NEAR(plant.L, 0.3, 0.01);
}

// 30 seeds of the paper's noisy case (sd 0.0212, relay with a sampling time of 0.05 s): unbiased, and no wider than the
// spread of an independent output-error fit and pooled integrals (gain 0.027 by the formulas).
TEST(LiuGaoIdentification, NoisyRelayTestsScatterAroundTheTruth) {
    constexpr int kSeeds = 30;
    const double truth[] = {1, 10, 2};
    double mean[3] = {}, squares[3] = {};
    for (int seed = 1; seed <= kSeeds; ++seed) {
        RelaySettings settings;
        settings.u_plus = 1.3;
        settings.u_minus = -0.7;
        settings.hysteresis = 0.2;
        settings.noise_std = 0.0212132;
        settings.relay_sample_time = 0.05;
        settings.cycles = 13;
        settings.seed = seed;
        const auto experiment = simulate_relay(examples()[1].plant, settings, {});
        ASSERT_TRUE(experiment);
        Record record;
        record.t = experiment->record.t;
        record.u = experiment->record.u;
        record.y = experiment->record.y;
        IdentifyOptions options;
        options.model = ModelChoice::fopdt;
        const auto model = identify(record, options, {});
        ASSERT_TRUE(model) << model.error().message;
        const auto& plant = std::get<Fopdt>(model->plant);
        const double values[] = {plant.K, plant.T, plant.L};
        for (int k = 0; k < 3; ++k) {
            mean[k] += (values[k] - truth[k]) / kSeeds;
            squares[k] += (values[k] - truth[k]) * (values[k] - truth[k]);
        }
    }
    const double widest[] = {0.0225, 0.25, 0.0125};
    for (int k = 0; k < 3; ++k) {
        const double spread = std::sqrt((squares[k] - kSeeds * mean[k] * mean[k]) / (kSeeds - 1));
        EXPECT_LE(std::abs(mean[k]), 3 * spread / std::sqrt(kSeeds)) << k;
        EXPECT_LE(spread, widest[k]) << k;
    }
}

}  // namespace
}  // namespace tunewright
