// Hägglund and Åström (2004): AMIGO over the test batch, tuned from the plants and evaluated, compared with Ms, Mt and
// IAE of an independent solver (tests/data/robust, cases amigo_pid and amigo_pi).
#include <gtest/gtest.h>

#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"
#include "tests/engine/tuning/reference_batch.h"

namespace tunewright {
namespace {

void expect_reference(const nlohmann::json& row, const std::string& controller, const std::string& reference_case) {
    SCOPED_TRACE(row.at("id").get<std::string>() + " " + reference_case);
    const auto& reference = row.at(reference_case);
    TuningRequest request;
    request.subject = test::subject_of(test::plant_of(row));
    request.tune = {MethodRequest{.method = "amigo", .options = {}}};
    request.tune[0].options.set("controller", controller);
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    ASSERT_TRUE(result) << result.error().message;
    const auto& evaluation = result->controllers.at(0).evaluation;
    ASSERT_TRUE(evaluation);
    ASSERT_EQ(evaluation->robustness.stable, reference.at("stable").get<bool>());
    if (!evaluation->robustness.stable) return;
    // The reference has six digits, for tangent models rounded to six.
    EXPECT_NEAR(*evaluation->robustness.Ms / reference.at("Ms").get<double>(), 1, 5e-5);
    EXPECT_NEAR(*evaluation->robustness.Mt / reference.at("Mt").get<double>(), 1, 5e-5);
    EXPECT_NEAR(*evaluation->performance.load.IAE / reference.at("IAE").get<double>(), 1, 2e-4);
}

TEST(AmigoBatch, PidEvaluatesAsTheReferenceOnEveryPlant) {
    for (const auto& row : test::reference_rows()) expect_reference(row, "PID", "amigo_pid");
}

TEST(AmigoBatch, PiEvaluatesAsTheReferenceOnEveryPlant) {
    for (const auto& row : test::reference_rows()) expect_reference(row, "PI", "amigo_pi");
}

}  // namespace
}  // namespace tunewright
