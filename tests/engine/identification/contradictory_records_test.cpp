// Records that no linear model of u explains, and times in both directions: the reported findings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "engine/identification/model_grade.h"
#include "engine/plant/linear/linear_plant.h"
#include "tests/engine/identification/identified.h"
#include "tests/engine/simulation/replay/replay_loop.h"

namespace tunewright {
namespace {

using testing::identified;
using testing::warns;

/// A lag of 60 s towards `goal` of the time, with u given by `level`, every 5 s.
Record towards(const std::function<double(double)>& goal, const std::function<double(double)>& level) {
    Record record;
    double y = 24;
    for (int i = 0; i < 500; ++i) {
        const double t = 5 * i;
        record.t.push_back(t);
        record.u.push_back(level(t));
        record.y.push_back(std::round(100 * y) / 100);
        y += (goal(t) - y) * -std::expm1(-5.0 / 60);
    }
    return record;
}

std::string detail_of(const IdentifiedModel& model, const std::string& code) {
    for (const Warning& warning : model.warnings) {
        if (warning.code == code) return warning.detail;
    }
    return "";
}

/// An oven's log whose output column shows the climb at 100 % and the holding at 40 and 65 %, independent of y.
TEST(ContradictoryRecords, YThatSettlesAtTwoLevelsUnderOneUIsSaidToContradict) {
    const Record record = towards([](double t) { return t < 60     ? 24
                                                        : t < 1110 ? 150
                                                                   : 290; },
                                  [](double t) {
                                      return t < 60 ? 0 : t < 610 ? 100 : t < 1110 ? 40 : t < 1960 ? 100 : 65;
                                  });
    const IdentifiedModel model = identified(record);
    ASSERT_TRUE(warns(model, "contradictory-levels"));
    EXPECT_THAT(detail_of(model, "contradictory-levels"), ::testing::HasSubstr("u = 100 y settles at 150"));
    EXPECT_EQ(grade_of(model), ModelGrade::doubtful);
}

/// A load that the controller answers brings u back to its first level at another y: the model is right nevertheless.
TEST(ContradictoryRecords, ALoadInALoopIsNoReasonAgainstTheModel) {
    const Fopdt plant{.K = 2, .T = 40, .L = 8};
    constexpr std::array kLevels = {50.0, 55.0, 50.0, 56.0, 51.0, 57.0, 50.0, 54.0, 49.0, 55.0};
    test::OwnHour hour{.h = 4, .r = {}, .load = {}, .output = {}};
    for (int k = 0; k < 1000; ++k) {
        hour.r.push_back(kLevels[static_cast<std::size_t>((k + 20) / 100 % 10)]);
        hour.load.push_back(k > 330 && k < 640 ? 1.6 : 0);
        hour.output.push_back(0.02 * std::sin(37.0 * k));
    }
    LoopRows rows = test::own_loop(plant, {.Kp = 0.5, .Ki = 0.012}, hour, 40);
    Record record;
    for (std::size_t k = 0; k < rows.size(); ++k) record.t.push_back(hour.h * static_cast<double>(k));
    for (double& u : rows.u) u = 0.1 * std::round(10 * u);
    record.u = rows.u;
    record.y = rows.y;
    record.r = rows.r;
    const IdentifiedModel model = identified(record);
    const auto warning = std::ranges::find(model.warnings, "contradictory-levels", &Warning::code);
    ASSERT_NE(warning, model.warnings.end());
    EXPECT_EQ(warning->level, WarningLevel::warning);
    EXPECT_NEAR(parameter(model.plant, "K"), plant.K, 0.1 * plant.K);
}

/// The levels of a plant whose gain falls from 3 to 1.
TEST(ContradictoryRecords, AGainThatFallsOverTheRangeIsNamedPartByPart) {
    const auto level = [](double t) { return t < 200 ? 0.0 : t < 800 ? 30.0 : t < 1400 ? 60.0 : 90.0; };
    const Record record = towards(
        [&](double t) {
            const double u = level(t);
            return 24 + 3 * std::min(u, 30.0) + 2 * std::clamp(u - 30, 0.0, 30.0) + std::max(u - 60, 0.0);
        },
        level);
    const IdentifiedModel model = identified(record);
    EXPECT_THAT(detail_of(model, "gain-varies"),
                ::testing::HasSubstr("3 from u = 0 to 30, 2 from u = 30 to 60, 1 from u = 60 to 90"));
}

TEST(ContradictoryRecords, ALinearPlantIsNotSaidToContradict) {
    const auto level = [](double t) { return t < 200 ? 0.0 : t < 800 ? 30.0 : t < 1400 ? 60.0 : 30.0; };
    const IdentifiedModel model = identified(towards([&](double t) { return 24 + 2 * level(t); }, level));
    EXPECT_FALSE(warns(model, "contradictory-levels"));
    EXPECT_FALSE(warns(model, "gain-varies"));
}

TEST(TimeDirection, TimesThatFallAreACountdownWhereYFollowsUSo) {
    const auto level = [](double t) { return t < 300 ? 20.0 : t < 1300 ? 50.0 : 35.0; };
    Record record = towards([&](double t) { return 2 * level(t) - 16; }, level);
    const double end = record.t.back();
    for (double& t : record.t) t = end - t;
    const IdentifiedModel counted = identified(record);
    EXPECT_NEAR(LinearPlant::make(counted.plant)->low_frequency_gain(), 2, 0.02);
    EXPECT_THAT(detail_of(counted, "reversed-time"), ::testing::HasSubstr("count down"));

    for (double& t : record.t) t = end - t;
    for (auto* column : {&record.t, &record.u, &record.y}) std::reverse(column->begin(), column->end());
    const IdentifiedModel turned = identified(record);
    EXPECT_NEAR(LinearPlant::make(turned.plant)->low_frequency_gain(), 2, 0.02);
    EXPECT_THAT(detail_of(turned, "reversed-time"), ::testing::HasSubstr("reversed"));
}

}  // namespace
}  // namespace tunewright
