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

TEST(Candidates, ThoseThatFitMuchWorseAreTold) {
    IdentifiedModel model;
    for (const double fit : {93.9, 97.0, 94.0, 94.1}) model.candidates.emplace_back().fit_percent = fit;
    grade_candidates(model);
    std::vector<bool> worse;
    for (const Candidate& candidate : model.candidates) worse.push_back(candidate.much_worse);
    EXPECT_EQ(worse, (std::vector<bool>{true, false, false, false})) << "3 points below the best are not yet much";
    IdentifiedModel none;
    grade_candidates(none);
}

TEST(Candidates, ATimeWhoseErrorIsLongerThanTheRecordIsNotDetermined) {
    IdentifiedModel model;
    model.fit.t = {100, 500, 900};
    model.candidates.emplace_back().standard_errors = {{"K", 2e3}, {"L", 799}, {"T1", 801}, {"zeta", 1e9}};
    model.candidates.emplace_back().standard_errors = {{"T", 2.1e8}, {"L", 2e4}};
    for (int twice = 0; twice < 2; ++twice) grade_candidates(model);
    EXPECT_EQ(model.candidates[0].undetermined, std::vector<std::string>{"T1"}) << "no gain, no ratio";
    EXPECT_EQ(model.candidates[1].undetermined, (std::vector<std::string>{"L", "T"}));
}

}  // namespace
}  // namespace tunewright
