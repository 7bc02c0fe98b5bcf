// tune(): the request's methods in order, failures as entries, ranking, progress, cancellation, records.
#include "engine/request/tune.h"
#include "engine/evaluation/best_so_far.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

MethodRequest method(const std::string& id, const std::vector<std::pair<std::string, OptionValue>>& given = {}) {
    MethodRequest request{.method = id, .options = {}};
    for (const auto& [path, value] : given) request.options.set(path, value);
    return request;
}

TuningRequest request_for(const Plant& plant, std::vector<MethodRequest> methods) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = std::move(methods);
    request.evaluate.points = 0;
    return request;
}

const Sopdt kPlant{.K = 2, .T1 = 10, .T2 = 4, .L = 3};

std::vector<std::string> methods_of(const TuningResult& result) {
    std::vector<std::string> ids;
    for (const auto& entry : result.controllers) ids.push_back(entry.method);
    return ids;
}

TEST(Tune, JudgesANonlinearPlantByItselfAndComparesOnItsLinearisation) {
    TuningRequest request;
    request.subject = test::subject_of(cstr("CA"));
    request.tune = {method("robust")};
    request.evaluate.points = 0;
    request.evaluate.setpoint_step = 0.14;
    request.evaluate.optimum_at_Ms = true;
    const auto result = tune(request, {});
    ASSERT_TRUE(result && result->operating_point);
    EXPECT_NEAR(result->operating_point->states[0].value, 0.520329995811, 1e-9);
    const TuningEntry& robust = result->controllers.front();
    ASSERT_TRUE(robust.evaluation && robust.evaluation->linear && robust.optimum_at_Ms);
    EXPECT_NEAR(*robust.optimum_at_Ms->excess_percent, 0, 0.1);  // it is the optimum
    const double own = *robust.evaluation->performance.setpoint.IAE;
    const double linear = *robust.evaluation->linear->performance.setpoint.IAE;
    EXPECT_GT(std::abs(own / linear - 1), 0.02);
}

FrequencyResponse points_of(const Plant& plant) {
    const LinearPlant linear = *LinearPlant::make(plant);
    FrequencyResponse points;
    for (double omega = 0.005; omega < 5; omega *= 1.2) {
        const auto P = linear.at({0, omega});
        points.omega.push_back(omega);
        points.re.push_back(P.real());
        points.im.push_back(P.imag());
    }
    return points;
}

// Points have no response over time: the answer names the objective that was minimised, and warns if another was
// requested.
TEST(Tune, NamesTheObjectiveThatMeasuredPointsAllow) {
    TuningRequest request;
    request.subject = test::subject_of(points_of(kPlant));
    request.tune = {method("robust"), method("robust", {{"objective", "load_iae"}}),
                    method("robust", {{"objective", "load_ie"}})};
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    const auto warned = [&](std::size_t i) {
        return std::ranges::count(result->controllers[i].evaluation->warnings, "objective-replaced", &Warning::code);
    };
    EXPECT_EQ(result->controllers[0].options.text("objective"), "load_ie");
    EXPECT_EQ(warned(0), 0);
    EXPECT_EQ(warned(1), 1);
    EXPECT_EQ(warned(2), 0);
    const auto on_model = tune(request_for(kPlant, {method("robust")}), {});
    ASSERT_TRUE(on_model);
    EXPECT_EQ(on_model->controllers[0].options.text("objective"), "load_iae");
}

TEST(Tune, AnswersEveryMethodInRequestOrderAndTheBaselineLast) {
    auto request = request_for(kPlant, {method("simc"), method("amigo"), method("simc", {{"tau_c", 9.0}})});
    request.baseline = IdealPid{.Kp = 0.5, .Ti = 10};
    const auto result = tune(request, {});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_THAT(methods_of(*result), ElementsAre("simc", "amigo", "simc", "baseline"));
    for (const auto& entry : result->controllers) {
        ASSERT_TRUE(entry.evaluation) << entry.method;
        EXPECT_TRUE(entry.evaluation->robustness.stable) << entry.method;
        EXPECT_FALSE(entry.title.empty() || entry.source.empty());
    }
    EXPECT_EQ(result->controllers[2].options.number("tau_c"), 9.0);
    EXPECT_TRUE(result->controllers[1].reduced_model);
    EXPECT_FALSE(result->controllers[0].reduced_model);
    EXPECT_FALSE(result->model);
    EXPECT_FALSE(result->partial);
    EXPECT_EQ(std::get<IdealPid>(result->controllers[3].evaluation->controller).Kp, 0.5);
}

TEST(Tune, RanksWithinTheMsLimitThenTheRestThenTheUnstable) {
    // Ziegler-Nichols is fast but far above Ms = 2 here; the baseline does not stabilise the plant.
    auto request =
        request_for(kPlant, {method("ziegler_nichols_step"), method("simc", {{"tau_c", 12.0}}), method("simc")});
    request.baseline = IdealPid{.Kp = 50, .Ti = 10};
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    const auto& entries = result->controllers;
    EXPECT_GT(*entries[0].evaluation->robustness.Ms, 2);
    EXPECT_LT(*entries[0].evaluation->performance.load.IAE, *entries[2].evaluation->performance.load.IAE);
    EXPECT_FALSE(entries[3].evaluation->robustness.stable);
    EXPECT_THAT(result->ranking, ElementsAre(1, 2, 0, 3));
    EXPECT_EQ(
        result->ranking_by,
        "excess of the load IAE over the least at the same Ms, among stable entries that settle with Ms <= 2, then "
        "the rest");

    request.evaluate.rank_Ms = 20;
    EXPECT_THAT(tune(request, {})->ranking, ElementsAre(0, 1, 2, 3));
}

TEST(Tune, MethodThatFailsIsAnEntryWithItsErrorAndDoesNotRank) {
    const auto result = tune(request_for(Fopdt{.K = 1, .T = 5, .L = 0}, {method("amigo"), method("lambda")}), {});
    ASSERT_TRUE(result);
    ASSERT_TRUE(result->controllers[0].error);
    EXPECT_EQ(result->controllers[0].error->kind, ErrorKind::unsupported);
    EXPECT_EQ(result->controllers[0].error->where, "plant/L");
    EXPECT_FALSE(result->controllers[0].evaluation);
    EXPECT_THAT(result->ranking, ElementsAre(1));
}

TEST(Tune, FailsOnlyIfAllMethodsFail) {
    const Fopdt plant{.K = 1, .T = 5, .L = 0};
    const auto one = tune(request_for(plant, {method("amigo")}), {});
    ASSERT_FALSE(one);
    EXPECT_EQ(one.error().kind, ErrorKind::unsupported);
    EXPECT_THAT(one.error().message, HasSubstr("AMIGO divides by the dead time"));

    const auto two = tune(request_for(plant, {method("amigo"), method("ziegler_nichols_step")}), {});
    ASSERT_FALSE(two);
    EXPECT_THAT(two.error().message, HasSubstr("amigo: AMIGO divides"));
    EXPECT_THAT(two.error().message, HasSubstr("ziegler_nichols_step: Ziegler-Nichols divides"));
}

TEST(Tune, OptionErrorsCarryTheirPlaceInTheRequest) {
    const TransferFunction jumps{.num = {1, 2}, .den = {1, 1}, .L = 1};
    const auto result = tune(
        request_for(jumps, {method("amigo"), method("amigo", {{"reduction/method", std::string("tangent")}})}), {});
    ASSERT_TRUE(result);
    ASSERT_TRUE(result->controllers[1].error);
    EXPECT_EQ(result->controllers[1].error->where, "tune/1/reduction/method");
}

TEST(Tune, RefusesRequestsThatAreNoneWithAPlace) {
    auto request = request_for(kPlant, {method("imaginary")});
    auto refused = tune(request, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "tune/0/method");
    EXPECT_THAT(refused.error().message, HasSubstr("\"imaginary\"; it must be one of "));

    refused = tune(request_for(kPlant, {}), {});
    EXPECT_EQ(refused.error().where, "tune");

    request = request_for(kPlant, {method("simc")});
    request.ultimate = UltimateTest{};
    EXPECT_THAT(tune(request, {}).error().message, HasSubstr("more than one of plant, record, model and ultimate"));
    request.subject.reset();
    request.ultimate.reset();
    EXPECT_THAT(tune(request, {}).error().message, HasSubstr("none of plant, record, model and ultimate"));
}

TEST(Tune, MethodWarningsComeBeforeThoseOfTheEvaluation) {
    const auto result = tune(request_for(Fopdt{.K = 1, .T = 5, .L = 1}, {method("simc")}), {});
    ASSERT_TRUE(result);
    ASSERT_FALSE(result->controllers[0].evaluation->warnings.empty());
    EXPECT_EQ(result->controllers[0].evaluation->warnings[0].code, "no-derivative");
}

TEST(Tune, ProgressNeverFallsEndsAtOneAndCarriesTheBestSoFar) {
    std::vector<Progress> seen;
    RunControl control;
    control.progress = [&](const Progress& progress) { seen.push_back(progress); };
    const auto result = tune(request_for(kPlant, {method("simc", {{"tau_c", 12.0}}), method("simc")}), control);
    ASSERT_TRUE(result);
    ASSERT_GE(seen.size(), 3u);
    for (size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i].fraction, seen[i - 1].fraction);
    EXPECT_EQ(seen.back().fraction, 1);
    EXPECT_FALSE(seen.front().best);
    ASSERT_TRUE(seen.back().best);
    EXPECT_EQ(seen.back().best->load_IAE, *result->controllers[1].evaluation->performance.load.IAE);
}

TEST(Tune, CancelledBeforeADesignIsAnErrorAfterwardsAPartialResult) {
    std::stop_source stop;
    RunControl control;
    control.stop = stop.get_token();
    control.progress = [&](const Progress& progress) {
        if (progress.best) stop.request_stop();
    };
    auto request = request_for(kPlant, {method("simc"), method("amigo"), method("lambda")});
    request.baseline = IdealPid{.Kp = 0.5, .Ti = 10};
    const auto partial = tune(request, control);
    ASSERT_TRUE(partial);
    EXPECT_TRUE(partial->partial);
    // The report before the second method carries the first design; that method is still finished.
    EXPECT_THAT(methods_of(*partial), ElementsAre("simc", "amigo"));
    EXPECT_EQ(partial->ranking.size(), 2u);

    const auto nothing = tune(request, control);
    ASSERT_FALSE(nothing);
    EXPECT_EQ(nothing.error().kind, ErrorKind::cancelled);
}

TEST(Tune, ComputeTimeIsTheGivenClocks) {
    double now = 0;
    RunControl control;
    control.now_ms = [&] { return now += 5; };
    const auto result = tune(request_for(kPlant, {method("simc")}), control);
    ASSERT_TRUE(result);
    EXPECT_GE(result->controllers[0].evaluation->compute_ms, 5);
    EXPECT_EQ(tune(request_for(kPlant, {method("simc")}), {})->controllers[0].evaluation->compute_ms, 0);
}

TEST(Tune, RecordIsIdentifiedFirstAndTheModelIsTuned) {
    Record record;
    for (int i = 0; i <= 300; ++i) {
        const double t = 0.2 * i;
        record.t.push_back(t);
        record.u.push_back(t < 4 ? 20 : 30);
        record.y.push_back(50 + (t < 6 ? 0 : 10 * 1.5 * (1 - std::exp(-(t - 6) / 8))));
    }
    TuningRequest request;
    request.record = record;
    request.tune = {method("simc", {{"controller", std::string("PI")}})};
    request.evaluate.points = 0;
    std::vector<Progress> seen;
    RunControl control;
    control.progress = [&](const Progress& progress) { seen.push_back(progress); };
    const auto result = tune(request, control);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_TRUE(result->model);
    EXPECT_GT(result->model->fit_percent, 99);
    // K 1.5, T 8, L 2: Kp = 8/(1.5 4), Ti = 8.
    const IdealPid pid = std::get<IdealPid>(result->controllers[0].evaluation->controller);
    EXPECT_NEAR(pid.Kp, 8 / 6.0, 0.05);
    EXPECT_NEAR(pid.Ti, 8, 0.2);
    EXPECT_EQ(seen.front().stage, "identify");
    for (size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i].fraction, seen[i - 1].fraction);
}

TEST(Tune, RecordThatCannotBeIdentifiedFailsWithThatReason) {
    TuningRequest request;
    request.record.emplace();
    request.record->t = {0, 1, 2};
    request.record->u = {1, 1, 1};
    request.record->y = {0, 0, 0};
    request.tune = {method("simc")};
    const auto result = tune(request, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::not_identifiable);
}

}  // namespace
}  // namespace tunewright
