// Method "all": its rows, the reasons of methods without a result, and the excess of each row over the optimum at its
// Ms.
#include "engine/request/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/request/tune.h"
#include "engine/tuning/registry.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

const Fopdt kPlant{.K = 2, .T = 10, .L = 3};

TuningResult compare_all(const Plant& plant, MethodOptions options = {}) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = {{.method = "all", .options = std::move(options)}};
    request.baseline = IdealPid{.Kp = 0.5, .Ti = 10};
    request.evaluate.points = 0;
    auto result = tune(request, {});
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result ? std::move(*result) : TuningResult{};
}

const TuningEntry& entry_of(const TuningResult& result, std::string_view method) {
    const auto at = std::ranges::find(result.controllers, method, &TuningEntry::method);
    EXPECT_NE(at, result.controllers.end()) << method;
    return *at;
}

MethodOptions options(const std::string& path, OptionValue value) {
    MethodOptions options;
    options.set(path, std::move(value));
    return options;
}

std::vector<PlannedRow> rows_of(const std::string& method, const MethodOptions& given) {
    std::vector<PlannedRow> rows;
    for (PlannedRow& row : comparison_rows(given))
        if (row.method->id == method) rows.push_back(std::move(row));
    return rows;
}

TEST(Comparison, MakesARowOfEveryMethodForEachControllerWithIntegralAction) {
    for (const TuningMethod& method : method_registry())
        EXPECT_EQ(rows_of(method.id, {}).empty(), !method.compared) << method.id;
    const auto rows = rows_of("ziegler_nichols_step", {});
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].title(), "Ziegler-Nichols, step response (PI)");
    EXPECT_EQ(rows[1].options.text("controller"), "PID");
}

TEST(Comparison, AnOptionThatIsGivenSettlesTheVariantAndReachesTheMethodsThatKnowIt) {
    const auto P = rows_of("ziegler_nichols_step", options("controller", std::string("P")));
    ASSERT_EQ(P.size(), 1u);
    EXPECT_EQ(P[0].options.text("controller"), "P");
    EXPECT_FALSE(P[0].refusal);
    EXPECT_EQ(rows_of("simc", options("tau_c", 7.0))[0].options.number("tau_c"), 7);
    EXPECT_FALSE(rows_of("amigo", options("tau_c", 7.0))[0].options.has("tau_c"));
}

TEST(Comparison, AnOptionThatDoesNotSuitAMethodIsItsRefusal) {
    const auto no_P = rows_of("robust", options("controller", std::string("P")));
    ASSERT_EQ(no_P.size(), 1u);
    ASSERT_TRUE(no_P[0].refusal);
    EXPECT_THAT(no_P[0].refusal->message, HasSubstr("controller is P; it must be one of PID, PI"));
    const auto no_PI = rows_of("rimc", options("controller", std::string("PI")));
    ASSERT_TRUE(no_PI[0].refusal);
    EXPECT_THAT(no_PI[0].refusal->message, HasSubstr("rimc tunes PID controllers only, but PI was requested"));
    const auto too_large = rows_of("robust", options("Ms", 5.0));
    ASSERT_TRUE(too_large[0].refusal);
    EXPECT_THAT(too_large[0].refusal->message, HasSubstr("Ms is 5; it must be above 1 and at most 4"));
    EXPECT_EQ(too_large[0].refusal->kind, ErrorKind::unsupported);
}

TEST(Comparison, ARuleWithoutDerivativeHasOneRow) {
    const auto rows = [](const TuningResult& result) {
        return std::ranges::count(result.controllers, std::string("simc"), &TuningEntry::method);
    };
    EXPECT_EQ(rows(compare_all(kPlant)), 1) << "first order: SIMC's PID is its PI";
    EXPECT_EQ(rows(compare_all(Sopdt{.K = 2, .T1 = 10, .T2 = 4, .L = 3})), 2);
}

TEST(Comparison, HasMoreThanTwentyFiveRowsOnAFirstOrderPlant) {
    const auto result = compare_all(kPlant);
    EXPECT_GE(std::ranges::count_if(result.controllers, [](const auto& e) { return e.evaluation.has_value(); }), 40);
    EXPECT_EQ(result.ranking.size(), result.controllers.size() - 1) << "Visioli's rule is for integrating plants alone";
}

TEST(Comparison, TellsWhyARuleDoesNotApply) {
    const auto result = compare_all(Fopdt{.K = 1, .T = 5, .L = 0});
    const TuningEntry& amigo = entry_of(result, "amigo");
    ASSERT_TRUE(amigo.error);
    EXPECT_THAT(amigo.error->message, HasSubstr("dead time"));
    EXPECT_EQ(amigo.title, "AMIGO (PI)");
    EXPECT_TRUE(entry_of(result, "lambda").evaluation);
}

TEST(Comparison, TheRobustOptimumItselfLiesAtTheOptimumAndNoRuleWithItsFilterBelow) {
    const auto result = compare_all(kPlant);
    for (const TuningEntry& entry : result.controllers) {
        if (!entry.evaluation) continue;
        ASSERT_TRUE(entry.optimum_at_Ms) << entry.title;
        const auto& Ms = entry.evaluation->robustness.Ms;
        if (!Ms || *Ms > 4) {
            EXPECT_FALSE(entry.optimum_at_Ms->IAE) << entry.title;
            EXPECT_FALSE(entry.optimum_at_Ms->IAE.why.empty()) << entry.title;
            continue;
        }
        ASSERT_TRUE(entry.optimum_at_Ms->excess_percent) << entry.title;
        if (std::get_if<IdealPid>(&entry.evaluation->controller) == nullptr) continue;
        if (std::get<IdealPid>(entry.evaluation->controller).Td == 0) {
            EXPECT_GT(*entry.optimum_at_Ms->excess_percent, 0) << entry.title;
        }
    }
    EXPECT_NEAR(*entry_of(result, "robust").optimum_at_Ms->excess_percent, 0, 0.01);
    // 20.0 = Ti/Kp of the baseline, whose response does not overshoot.
    const OptimumAtMs& today = *entry_of(result, "baseline").optimum_at_Ms;
    EXPECT_NEAR(*today.excess_percent, 100 * (20.0 / *today.IAE - 1), 0.01);
}

TEST(Comparison, TheOptimumIsThatOfTheRobustMethodAtTheSameMs) {
    const auto result = compare_all(kPlant);
    const TuningEntry& simc = entry_of(result, "simc");
    const double Ms = *simc.evaluation->robustness.Ms;
    TuningRequest request;
    request.subject = test::subject_of(Plant(kPlant));
    request.tune[0].options.set("Ms", Ms);
    request.tune[0].options.set("Mt", Ms);
    const auto robust = tune(request, {});
    ASSERT_TRUE(robust);
    EXPECT_NEAR(*simc.optimum_at_Ms->IAE / *robust->controllers[0].evaluation->performance.load.IAE, 1, 2e-4);
    EXPECT_FALSE(robust->controllers[0].optimum_at_Ms) << "asked for by all alone";
}

TEST(Comparison, TheOptimumColumnCanBeLeftOutOfAllAndAskedForOfOne) {
    TuningRequest request;
    request.subject = test::subject_of(Plant(kPlant));
    request.evaluate.optimum_at_Ms = true;
    const auto one = tune(request, {});
    ASSERT_TRUE(one);
    EXPECT_TRUE(one->controllers[0].optimum_at_Ms);
    request.tune = {{.method = "all", .options = {}}};
    request.evaluate.optimum_at_Ms = false;
    const auto all = tune(request, {});
    ASSERT_TRUE(all);
    for (const auto& entry : all->controllers) EXPECT_FALSE(entry.optimum_at_Ms) << entry.title;
}

TEST(Comparison, ReasonsThatMethodsShareAreToldOnceWhereNoneWorks) {
    TuningRequest request;
    request.subject = test::subject_of(Plant(TransferFunction{.num = {1, 0}, .den = {1, 2, 1}, .L = 1}));
    request.tune = {{.method = "all", .options = {}}};
    const auto result = tune(request, {});
    ASSERT_FALSE(result);
    const std::string& message = result.error().message;
    const std::string reason = "has a zero at s = 0: it has no static gain";
    const auto first = message.find(reason);
    ASSERT_NE(first, std::string::npos) << message;
    EXPECT_EQ(message.find(reason, first + 1), std::string::npos) << message;
}

}  // namespace
}  // namespace tunewright
