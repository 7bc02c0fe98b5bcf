// Closed loops: found, with a warning, identified if set points move, refused if only feedback moves u. Loops and
// open-loop tests are simulated from seeds (tests/records/closed_loop_records.h).
#include "engine/identification/closed_loop/feedback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/identification/identify.h"
#include "engine/plant/linear/linear_plant.h"
#include "tests/engine/identification/record_files.h"
#include "tests/engine/identification/simulated_record.h"
#include "tests/long_or_quick.h"
#include "tests/records/closed_loop_records.h"

namespace tunewright {
namespace {

using testing::LoopTest;
using testing::open_loop_test;
using testing::simulated_loop;
using testing::SimulatedTest;

bool warns_of_feedback(const IdentifiedModel& model) {
    return std::any_of(model.warnings.begin(), model.warnings.end(),
                       [](const Warning& warning) { return warning.code == "closed-loop"; });
}

std::optional<Feedback> feedback_of(const Record& record) {
    const auto clean = clean_record(record);
    return clean ? find_feedback(*clean) : std::nullopt;
}

/// y = K e^(-Ls)/(Ts + 1) u + noise under u = -Kp (y - r) - Kp/Ti * integral, sampled with the rows.
struct PiLoop {
    double K = 2, T = 20, L = 3, Kp = 1.5, Ti = 20, noise = 0.05;
    int rows = 1200, move_every = 300;
    double move = 1, load = 0;
    bool with_r = true;

    Record record() const {
        Record out;
        testing::Dice dice(7);
        testing::PlantRun plant({K, T, 0, L, false}, 1);
        double y = 0, integral = 0;
        for (int i = 0; i < rows; ++i) {
            const double r = (i / move_every) % 2 == 1 ? move : 0;
            const double seen = y + noise * dice.normal();
            integral += Ti > 0 ? Kp / Ti * (r - seen) : 0;
            const double u = Kp * (r - seen) + integral;
            out.t.push_back(i);
            out.u.push_back(40 + u);
            out.y.push_back(70 + seen);
            if (with_r) out.r.push_back(70 + r);
            y = plant.advance(u + ((i / 170) % 2 == 1 ? load : 0));
        }
        return out;
    }
};

const Fopdt& fopdt_of(const IdentifiedModel& model) {
    static const Fopdt none{};
    const auto* found = std::get_if<Fopdt>(&model.plant);
    EXPECT_NE(found, nullptr) << model.choice_reason;
    return found != nullptr ? *found : none;
}

TEST(Feedback, SetPointStepsTellThePlantWithinItsErrors) {
    const auto model = identify(PiLoop{}.record(), {}, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_TRUE(warns_of_feedback(*model));
    ASSERT_TRUE(model->data_quality.closed_loop);
    EXPECT_EQ(model->data_quality.closed_loop->used, LoopExcitation::set_point);
    const Fopdt& plant = fopdt_of(*model);
    EXPECT_NEAR(plant.K, 2, 3 * model->standard_errors.at("K"));
    EXPECT_NEAR(plant.T, 20, 3 * model->standard_errors.at("T"));
    EXPECT_LT(model->standard_errors.at("K"), 0.1);
}

TEST(Feedback, OneMoveOfTheSetPointTellsTheGainAsFarAsItsNoiseAllows) {
    for (const double noise : {0.002, 0.02}) {
        const auto model = identify(PiLoop{.noise = noise, .rows = 900, .move_every = 450}.record(), {}, {});
        ASSERT_TRUE(model) << model.error().message;
        const Fopdt& plant = fopdt_of(*model);
        const double error = model->standard_errors.at("K");
        EXPECT_NEAR(plant.K, 2, 4 * error) << noise;
        EXPECT_LT(error, 0.1) << noise;
    }
}

TEST(Feedback, KicksOfTheControllerStandInForAColumnOfTheSetPoint) {
    PiLoop loop;
    loop.with_r = false;
    const auto model = identify(loop.record(), {}, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_TRUE(warns_of_feedback(*model));
    EXPECT_EQ(model->data_quality.closed_loop->used, LoopExcitation::outside_moves);
    EXPECT_NEAR(fopdt_of(*model).K, 2, 3 * model->standard_errors.at("K"));
}

TEST(Feedback, RegulationAloneIsRefusedWithTheTestToMake) {
    PiLoop loop;
    loop.move = 0;
    loop.load = 0.5;
    for (const double Ti : {20.0, 0.0}) {
        loop.Ti = Ti;
        const auto model = identify(loop.record(), {}, {});
        ASSERT_FALSE(model) << "K = " << fopdt_of(*model).K << ", where -1/Kp = " << -1 / loop.Kp;
        EXPECT_EQ(model.error().kind, ErrorKind::not_identifiable);
        EXPECT_EQ(model.error().where, "record");
        EXPECT_THAT(model.error().message, ::testing::HasSubstr("only feedback moves u"));
        EXPECT_THAT(model.error().message, ::testing::HasSubstr("column r"));
    }
}

TEST(Feedback, MeasuresHowWellYTellsU) {
    const auto found = feedback_of(PiLoop{}.record());
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->at_once);
    EXPECT_LT(found->by_y, 0.05 * found->by_u);
    EXPECT_EQ(found->outside.size(), 3U);
}

TEST(Feedback, SetPointAsLongAsTheOtherColumns) {
    Record record = PiLoop{}.record();
    record.r.pop_back();
    const auto model = identify(record, {}, {});
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().kind, ErrorKind::invalid_argument);
    EXPECT_EQ(model.error().where, "record/r");
}

TEST(Feedback, AConstantSetPointBesideAnOpenLoopStepSaysNothing) {
    Record record = testing::simulate(testing::even_times(300, 1), 0, 0, {{20, 1}}, testing::first_order(2, 15, 4));
    testing::add_noise(record, 0.01, 3);
    record.r.assign(record.t.size(), 1.0);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    EXPECT_FALSE(warns_of_feedback(*model));
    EXPECT_FALSE(model->data_quality.closed_loop);
}

TEST(Feedback, RelayTestsStayRelayTests) {
    for (const char* file : {"relay_ex1_unbiased.csv", "relay_ex1_biased_noise.csv", "relay_unstable_unbiased.csv",
                             "relay_ex1_biased_nonuniform.csv"})
        EXPECT_FALSE(feedback_of(testing::read_record(file))) << file;
}

TEST(Feedback, OpenLoopTestsAreNotCalledClosedLoops) {
    constexpr unsigned kTests = 2000;
    constexpr int kAllowed = 10;  // 0.5 %
    int found = 0;
    std::string which;
    for (unsigned seed = 1; seed <= kTests; ++seed) {
        const SimulatedTest test = open_loop_test(seed);
        if (!feedback_of(test.record)) continue;
        ++found;
        which += test.what + "\n";
    }
    EXPECT_LE(found, kAllowed) << which;
}

/// Loops whose controller sees the recorded y: regulation of noise and loads.
TEST(Feedback, RegulationIsFound) {
    for (const LoopTest kind : {LoopTest::load_steps, LoopTest::noise_only}) {
        int found = 0, loops = 0;
        for (unsigned seed = 1; seed <= 400; ++seed) {
            const SimulatedTest test = simulated_loop(seed, kind);
            if (test.what.find("own_noise 1") != std::string::npos) continue;
            ++loops;
            found += feedback_of(test.record) ? 1 : 0;
        }
        EXPECT_GE(found, 0.94 * loops) << found << " of " << loops;
    }
}

double gain_of(const Plant& plant) {
    if (const auto* p = std::get_if<Fopdt>(&plant)) return p->K;
    if (const auto* p = std::get_if<Sopdt>(&plant)) return p->K;
    if (const auto* p = std::get_if<OscillatorySopdt>(&plant)) return p->K;
    if (const auto* p = std::get_if<TransferFunction>(&plant)) return p->num.back();
    return std::nan("");
}

/// The gain of a self-regulating plant is right within a tenth, or within three of its standard errors.
TEST(Feedback, GainsFromSetPointMovesAreRightWithinTheirErrors) {
    const int seeds = long_or_quick(60, 24);
    int right = 0, answers = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const SimulatedTest test = simulated_loop(static_cast<unsigned>(seed), LoopTest::set_points_with_r);
        if (test.plant.integrating) continue;
        const auto model = identify(test.record, {}, {});
        if (!model) continue;
        EXPECT_TRUE(warns_of_feedback(*model)) << test.what;
        const double off = std::abs(gain_of(model->plant) - test.plant.K);
        ++answers;
        right += off <= 0.1 * std::abs(test.plant.K) || off <= 3 * model->standard_errors.at("K") ? 1 : 0;
    }
    EXPECT_GE(answers, 2 * seeds / 3);
    EXPECT_GE(right, 0.93 * answers) << right << " of " << answers;
}

}  // namespace
}  // namespace tunewright
