// Responses of one answer share one horizon, within limits.
#include "engine/evaluation/response_pair.h"

#include <gtest/gtest.h>

#include "engine/request/evaluate_all.h"
#include "engine/request/tune.h"

namespace tunewright {
namespace {

EvaluationResult answer_on(const PlantModel& plant, const std::vector<GivenController>& controllers,
                           const EvaluateOptions& options = {}) {
    auto subject = AnalysedPlant::make(plant);
    auto result = evaluate_all(std::get<AnalysedPlant>(subject), controllers, options, std::nullopt, {}, {});
    EXPECT_TRUE(result);
    return std::move(*result);
}

double end_of(const TuningEntry& entry) { return entry.evaluation->responses->load.t.back(); }

const PlantModel kLag = Plant(Fopdt{.K = 1, .T = 10, .L = 2});
const IdealPid kQuick{.Kp = 3, .Ti = 8};

TEST(ResponsePair, ControllersOfOneAnswerEndAtOneTime) {
    const IdealPid slower{.Kp = 1.2, .Ti = 10};
    const double alone = end_of(answer_on(kLag, {slower}).controllers[0]);
    const auto together = answer_on(kLag, {kQuick, slower});
    for (const TuningEntry& entry : together.controllers) {
        const Responses& drawn = *entry.evaluation->responses;
        EXPECT_EQ(drawn.setpoint.t.back(), alone);
        EXPECT_EQ(drawn.load.t.back(), alone);
        EXPECT_EQ(drawn.load.t.size(), 400u);
        EXPECT_NEAR(drawn.load.y.back(), 0, 1e-2);
        EXPECT_EQ(drawn.course, nullptr) << "the nodes are let go";
    }
}

TEST(ResponsePair, ASluggishOneIsCutAtThreeTimesTheQuickest) {
    const IdealPid sluggish{.Kp = 0.01, .Ti = 10};
    const double alone = end_of(answer_on(kLag, {kQuick}).controllers[0]);
    const auto together = answer_on(kLag, {kQuick, sluggish});
    EXPECT_DOUBLE_EQ(end_of(together.controllers[0]), 3 * alone);
    EXPECT_DOUBLE_EQ(end_of(together.controllers[1]), 3 * alone);
    EXPECT_GT(together.controllers[1].evaluation->responses->load.y.back(), 0.3) << "it goes on to the edge";
}

TEST(ResponsePair, AGivenHorizonStands) {
    EvaluateOptions options;
    options.horizon = 17;
    for (const auto& entry : answer_on(kLag, {kQuick, IdealPid{.Kp = 1, .Ti = 10}}, options).controllers)
        EXPECT_EQ(end_of(entry), 17);
}

TEST(ResponsePair, EquationsAndTheirLinearisationEndTogether) {
    NonlinearPlant tank;
    tank.states = {{"h", 4}};
    tank.equations = {{"h", "(u - 2*sqrt(h))/5"}};
    tank.input = {"u", 4};
    tank.output = "h";
    const auto answer = answer_on(tank, {IdealPid{.Kp = 4, .Ti = 4}, IdealPid{.Kp = 1, .Ti = 8}});
    const double end = end_of(answer.controllers[0]);
    for (const TuningEntry& entry : answer.controllers) {
        EXPECT_EQ(end_of(entry), end);
        EXPECT_EQ(entry.evaluation->linear->responses->load.t.back(), end);
    }
}

TEST(ResponsePair, ARunThatDoesNotSettleIsDrawnAsFarAsItIsKnown) {
    StepResponse rests, hunts;
    rests.nodes = {{.t = 0, .y = 1}, {.t = 1, .y = 0}};
    hunts.nodes = {{.t = 0, .y = 1}, {.t = 3, .y = 1}};
    hunts.settles = false;
    const auto course_of = [](const StepResponse& run) {
        EvaluateOptions options;
        options.points = 11;
        return *drawn(KnownResponse::of(run), KnownResponse::of(run), options);
    };
    Responses quick = course_of(rests), moving = course_of(hunts);
    const double end = quick.load.t.back();
    draw_together({&quick, &moving});
    EXPECT_EQ(quick.load.t.back(), end) << "what hunts has no say";
    EXPECT_EQ(moving.load.t.back(), end);
    Responses alone = course_of(hunts);
    draw_together({&alone});
    EXPECT_EQ(alone.load.t.back(), 3);
}

}  // namespace
}  // namespace tunewright
