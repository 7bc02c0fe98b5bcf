// Moves of u between the rows that show them: the accuracy of the dead time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/identification/identified.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kRow = 10, kDeadTime = 12;

IdentifiedModel recorded_slowly(const Steps& steps) {
    Record record = simulate(even_times(80, kRow), 40, 60, steps, first_order(2, 60, kDeadTime));
    add_noise(record, 0.05, 2);
    return identified(record, ModelChoice::fopdt);
}

TEST(StepBetweenRows, ALoneMoveLeavesTheDeadTimeOpenByARow) {
    for (const double late : {1.0, 5.0, 9.0, 10.0}) {
        const IdentifiedModel model = recorded_slowly({{110 - late, 50}});
        const double error = model.standard_errors.at("L");
        EXPECT_NEAR(error, kRow / std::sqrt(3.0), 0.3) << late;
        EXPECT_NEAR(plant_as<Fopdt>(model).L, kDeadTime, 2 * error) << late;
        EXPECT_THAT(model.data_quality.notes, Contains(HasSubstr("known only to one row (10)"))) << late;
    }
}

TEST(StepBetweenRows, AMoveThatIsTakenToFallOnItsRowLeavesTheDeadTimeWhereItWas) {
    Record record = simulate(even_times(80, kRow), 40, 60, {{110, 50}}, first_order(2, 60, kDeadTime));
    EXPECT_NEAR(plant_as<Fopdt>(identified(record, ModelChoice::fopdt)).L, kDeadTime, 1e-3);
}

TEST(StepBetweenRows, MovesThatAllFallOnRowsAreTheRecordersOwn) {
    const IdentifiedModel model = recorded_slowly({{100, 50}, {350, 40}, {500, 50}});
    EXPECT_NEAR(plant_as<Fopdt>(model).L, kDeadTime, 0.5);
    EXPECT_LT(model.standard_errors.at("L"), 0.5);
}

TEST(StepBetweenRows, MovesThatLieApartLeaveWhatIsLeftOfARow) {
    const IdentifiedModel model = recorded_slowly({{101, 50}, {348, 40}, {505, 50}});
    const double error = model.standard_errors.at("L");
    EXPECT_NEAR(plant_as<Fopdt>(model).L, kDeadTime, 2 * error + 0.5);
    EXPECT_LT(error, 0.6 * kRow / std::sqrt(12.0));
}

TEST(StepBetweenRows, RowsThatAreSmallBesideTheDeadTimeStayWhereTheyAre) {
    Record record = simulate(even_times(800, 1), 40, 60, {{99.5, 50}}, first_order(2, 60, kDeadTime));
    add_noise(record, 0.05, 2);
    const IdentifiedModel model = identified(record, ModelChoice::fopdt);
    EXPECT_NEAR(plant_as<Fopdt>(model).L, kDeadTime - 0.5, 0.3);
}

}  // namespace
}  // namespace tunewright
