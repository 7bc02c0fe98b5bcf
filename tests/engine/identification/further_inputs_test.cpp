// Measured disturbances are identified together with u: each with its own gain, lag and dead time.
#include "engine/identification/further_inputs/further_inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/records/closed_loop_records.h"

namespace tunewright {
namespace {

using testing::LoopPlant;

/// u steps twice (or a PI controller holds y at its set point); the other inputs step occasionally.
struct TwoInputs {
    LoopPlant plant{2, 40, 8, 5, false};
    std::vector<LoopPlant> others = {{3, 25, 0, 8, false}};
    double noise = 0.05;
    bool closed = false;
    unsigned seed = 1;

    Record record() const {
        constexpr int kFine = 10;
        Record out;
        testing::Dice dice(seed);
        std::vector<testing::PlantRun> runs = {testing::PlantRun(plant, 1.0 / kFine)};
        std::vector<double> d(others.size(), 0);
        for (std::size_t k = 0; k < others.size(); ++k) {
            runs.emplace_back(others[k], 1.0 / kFine);
            out.d.push_back({"d" + std::to_string(k + 1), {}});
        }
        double y = 0, u = 0, integral = 0;
        for (int i = 0; i < 800; ++i) {
            const double seen = 20 + y + noise * dice.normal();
            if (closed) {
                integral += 0.02 * (20 - seen);
                u = 0.6 * (20 - seen) + integral;
                out.r.push_back(20);
            } else if (i == 30 || i == 400) {
                u += 10;
            }
            for (std::size_t k = 0; k < d.size(); ++k)
                if (i > 100 && i % (90 + 17 * static_cast<int>(k)) == 0) d[k] = dice.between(-10, 10);
            out.t.push_back(i);
            out.u.push_back(u);
            out.y.push_back(seen);
            for (std::size_t k = 0; k < d.size(); ++k) out.d[k].values.push_back(5 + d[k]);
            for (int step = 0; step < kFine; ++step) {
                y = runs[0].advance(u);
                for (std::size_t k = 0; k < d.size(); ++k) y += runs[k + 1].advance(d[k]);
            }
        }
        return out;
    }
};

double gain_beside_others(const Plant& plant) {
    return std::visit(
        [](const auto& p) {
            if constexpr (requires { p.K; })
                return static_cast<double>(p.K);
            else
                return std::nan("");
        },
        plant);
}

void expect_lag(const DisturbanceModel& found, const LoopPlant& truth) {
    const auto* plant = std::get_if<Fopdt>(&found.plant);
    ASSERT_NE(plant, nullptr);
    EXPECT_NEAR(plant->K, truth.K, 3 * found.standard_errors.at("K"));
    EXPECT_NEAR(plant->T, truth.T1, 3 * found.standard_errors.at("T"));
    EXPECT_NEAR(plant->L, truth.L, 3 * found.standard_errors.at("L") + 0.1);
    EXPECT_LT(found.standard_errors.at("K"), 0.05 * std::abs(truth.K));
}

TEST(FurtherInputs, BothModelsAreRightWithinTheirErrors) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        TwoInputs test;
        test.seed = seed;
        const auto model = identify(test.record(), {}, {});
        ASSERT_TRUE(model) << model.error().message;
        EXPECT_NEAR(gain_beside_others(model->plant), 2, 3 * model->standard_errors.at("K"));
        ASSERT_EQ(model->disturbances.size(), 1U);
        EXPECT_EQ(model->disturbances[0].name, "d1");
        EXPECT_GT(model->disturbances[0].share, 0.1);
        EXPECT_LT(model->disturbances[0].share, 0.9);
        expect_lag(model->disturbances[0], test.others[0]);
    }
}

/// Before the input is known its one lasting step looks like a load, or a drift: neither remains in the model.
TEST(FurtherInputs, AStepOfOneLeavesNoLoadAndNoDrift) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        testing::Dice dice(seed);
        testing::PlantRun of_u({2, 12, 0, 3, false}, 0.1), of_d({3, 20, 0, 1, false}, 0.1);
        Record record;
        record.d.push_back({"q", {}});
        double y = 0;
        for (int i = 0; i < 300; ++i) {
            const double u = i >= 30 && i < 150 ? 5 : 0, d = i > (seed % 2 == 0 ? 100 : 200) ? 1 : 0;
            record.t.push_back(i);
            record.u.push_back(u);
            record.d[0].values.push_back(d);
            record.y.push_back(20 + y + 0.05 * dice.normal());
            for (int k = 0; k < 10; ++k) y = of_u.advance(u) + of_d.advance(d);
        }
        const auto model = identify(record, {}, {});
        ASSERT_TRUE(model) << model.error().message;
        ASSERT_EQ(model->disturbances.size(), 1U) << "seed " << seed;
        expect_lag(model->disturbances[0], {3, 20, 0, 1, false});
        for (const Warning& warning : model->warnings)
            EXPECT_TRUE(warning.code != "load-disturbance" && warning.code != "drift") << "seed " << seed;
    }
}

TEST(FurtherInputs, OneThatDoesNothingLeavesThePlantAsItIs) {
    TwoInputs test;
    test.others[0].K = 0;
    Record record = test.record();
    const auto with = identify(record, {}, {});
    record.d.clear();
    const auto without = identify(record, {}, {});
    ASSERT_TRUE(with);
    ASSERT_TRUE(without);
    EXPECT_TRUE(with->disturbances.empty());
    EXPECT_EQ(gain_beside_others(with->plant), gain_beside_others(without->plant));
    EXPECT_EQ(with->standard_errors, without->standard_errors);
    EXPECT_THAT(with->data_quality.notes, ::testing::Contains(::testing::HasSubstr("\"d1\" explains no part")));
}

TEST(FurtherInputs, OfTwoTheOneThatMattersIsKept) {
    TwoInputs test;
    test.others = {{0, 30, 0, 3, false}, {-1.5, 60, 0, 2, false}};
    const auto model = identify(test.record(), {}, {});
    ASSERT_TRUE(model) << model.error().message;
    ASSERT_EQ(model->disturbances.size(), 1U);
    EXPECT_EQ(model->disturbances[0].name, "d2");
    expect_lag(model->disturbances[0], test.others[1]);
}

TEST(FurtherInputs, InALoopTheyAreNoExcitation) {
    TwoInputs test;
    test.closed = true;
    const auto model = identify(test.record(), {}, {});
    ASSERT_FALSE(model) << gain_beside_others(model->plant);
    EXPECT_THAT(model.error().message, ::testing::HasSubstr("closed loop"));
}

TEST(FurtherInputs, MoreThanFourAndUnequalColumnsAreRefused) {
    Record record = TwoInputs{}.record();
    record.d.assign(5, record.d[0]);
    EXPECT_EQ(identify(record, {}, {}).error().where, "record/d");
    record.d.resize(1);
    record.d[0].values.pop_back();
    EXPECT_EQ(identify(record, {}, {}).error().where, "record/d");
}

}  // namespace
}  // namespace tunewright
