// Grades of a model: the documented thresholds, from both sides.
#include "engine/identification/model_grade.h"

#include <gtest/gtest.h>

namespace tunewright {
namespace {

IdentifiedModel model_of(double fit_percent, std::vector<Warning> warnings = {}) {
    IdentifiedModel model;
    model.fit_percent = fit_percent;
    model.warnings = std::move(warnings);
    return model;
}

const Warning kDrift{"drift", "y drifts."};
const Warning kStructured{"structured-residuals", "It misses more than noise."};
const Warning kBad{"closed-loop", "It may be the controller's inverse.", WarningLevel::bad};

TEST(ModelGrade, AModelWithoutWarningsIsGoodFrom70PercentOn) {
    EXPECT_EQ(grade_of(model_of(70)), ModelGrade::good);
    EXPECT_EQ(grade_of(model_of(69.9)), ModelGrade::doubtful);
}

TEST(ModelGrade, WarningsMakeItUsableWithCare) {
    EXPECT_EQ(grade_of(model_of(99, {kDrift})), ModelGrade::usable);
    EXPECT_EQ(grade_of(model_of(69.9, {kDrift})), ModelGrade::doubtful);
}

TEST(ModelGrade, WhatMissesMoreThanNoiseNeeds90Percent) {
    EXPECT_EQ(grade_of(model_of(90, {kStructured})), ModelGrade::usable);
    EXPECT_EQ(grade_of(model_of(89.9, {kStructured})), ModelGrade::doubtful);
    EXPECT_EQ(grade_of(model_of(89.9, {kDrift})), ModelGrade::usable);
}

TEST(ModelGrade, AWarningThatItMayBeAnotherPlantMakesItDoubtful) {
    EXPECT_EQ(grade_of(model_of(99, {kDrift, kBad})), ModelGrade::doubtful);
}

TEST(ModelGrade, ADoubtfulModelHasAReasonAndOnlyADoubtfulOne) {
    EXPECT_EQ(reason_of_doubt(model_of(69.9)), DoubtReason::fit);
    EXPECT_EQ(reason_of_doubt(model_of(89.9, {kStructured})), DoubtReason::fit);
    EXPECT_EQ(reason_of_doubt(model_of(69.9, {kBad})), DoubtReason::fit);
    EXPECT_EQ(reason_of_doubt(model_of(99, {kBad})), DoubtReason::warning);
    for (const IdentifiedModel& model : {model_of(70), model_of(70, {kDrift}), model_of(90, {kStructured})})
        EXPECT_FALSE(reason_of_doubt(model));
}

}  // namespace
}  // namespace tunewright
