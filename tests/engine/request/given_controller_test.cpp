// Controllers of the user's choice in a tuning request: judged like designs, in their place among the entries.
#include "engine/request/given_controller.h"

#include <gtest/gtest.h>

#include "engine/evaluation/longest_sample_time.h"
#include "engine/request/evaluate_all.h"
#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

const Fopdt kHeater{.K = 2, .T = 10, .L = 3};
const IdealPid kByHand{.Kp = 0.9, .Ti = 8, .Td = 1, .filter = {FilterType::derivative, 0.2}};

TuningRequest given_request(std::vector<GivenController> controllers) {
    TuningRequest request;
    request.subject = test::subject_of(kHeater);
    request.controllers = std::move(controllers);
    request.evaluate.points = 50;
    return request;
}

TuningResult result_of(const TuningRequest& request) {
    auto result = tune(request, {});
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result ? std::move(*result) : TuningResult{};
}

std::vector<std::string> method_ids(const TuningResult& result) {
    std::vector<std::string> methods;
    for (const TuningEntry& entry : result.controllers) methods.push_back(entry.method);
    return methods;
}

TEST(GivenController, HasTheFiguresOfItsEvaluation) {
    TuningRequest request = given_request({kByHand});
    const TuningEntry entry = result_of(request).controllers.back();
    const auto alone = evaluate_all(*request.subject, {kByHand}, request.evaluate, {}, {}, {});
    ASSERT_TRUE(alone && entry.evaluation);
    const Evaluation &in_job = *entry.evaluation, &evaluated = *alone->controllers.front().evaluation;
    EXPECT_EQ(*in_job.robustness.Ms, *evaluated.robustness.Ms);
    EXPECT_EQ(*in_job.robustness.gain_margin, *evaluated.robustness.gain_margin);
    EXPECT_EQ(*in_job.performance.load.IAE, *evaluated.performance.load.IAE);
    EXPECT_EQ(*in_job.performance.setpoint.overshoot_percent, *evaluated.performance.setpoint.overshoot_percent);
    ASSERT_TRUE(in_job.responses && evaluated.responses);
    EXPECT_EQ(std::get<IdealPid>(in_job.controller), kByHand);
    // As for a design.
    ASSERT_TRUE(entry.longest_sample_time);
    EXPECT_EQ(**entry.longest_sample_time, **longest_sample_time_of(*request.subject, evaluated, {}));
    EXPECT_FALSE(entry.verdict.empty());
    EXPECT_TRUE(entry.standing);
}

TEST(GivenController, StandsBetweenDesignsAndTodaysSettings) {
    TuningRequest request = given_request({kByHand, ParallelPid{.Kp = 0.5, .Ki = 0.05}});
    request.tune = {{.method = "simc", .options = {}}, {.method = "robust", .options = {}}};
    request.baseline = IdealPid{.Kp = 0.3, .Ti = 10};
    const TuningResult result = result_of(request);
    EXPECT_EQ(method_ids(result), (std::vector<std::string>{"simc", "robust", "given", "given", "baseline"}));
    EXPECT_EQ(result.controllers[2].title, "Settings by hand 1");
    EXPECT_EQ(result.controllers[3].title, "Settings by hand 2");
    EXPECT_EQ(result.ranking.size(), 5U);
}

TEST(GivenController, NeedsNoMethod) {
    TuningRequest request = given_request({kByHand});
    request.tune.clear();
    EXPECT_EQ(method_ids(result_of(request)), std::vector<std::string>{"given"});
    request.controllers.clear();
    const auto refused = tune(request, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "tune");
}

// The limits of the designs are those of the comparison: a given controller neither has its own nor removes them.
TEST(GivenController, IsComparedWithinTheLimitsOfTheDesigns) {
    const IdealPid sharp{.Kp = 2, .Ti = 8};
    TuningRequest request = given_request({sharp});
    request.baseline = sharp;
    request.tune.front().options.set("Ms", 1.4);
    const TuningResult result = result_of(request);
    ASSERT_EQ(result.controllers.size(), 3U);
    const Standing &given = *result.controllers[1].standing, &today = *result.controllers[2].standing;
    ASSERT_GT(*given.Ms, 1.5);
    EXPECT_EQ(given.group, StandingGroup::above_limit);
    EXPECT_EQ(given.why, today.why);
    EXPECT_EQ(today.group, StandingGroup::above_limit);
    request.controllers.clear();
    EXPECT_EQ(result_of(request).controllers[1].standing->why, today.why);
}

TEST(GivenController, MayBeTheOneToTake) {
    TuningRequest request = given_request({IdealPid{.Kp = 0.8, .Ti = 6, .Td = 1.2}});
    request.tune = {{.method = "simc", .options = {}}};
    request.tune.front().options.set("tau_c", 20.0);
    const TuningResult result = result_of(request);
    ASSERT_TRUE(result.proposed);
    EXPECT_EQ(*result.proposed, 1);
    EXPECT_EQ(result.verdict.front().code, "take");
}

}  // namespace
}  // namespace tunewright
