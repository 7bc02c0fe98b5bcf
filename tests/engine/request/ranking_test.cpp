// The order of a comparison: an entry that oscillates or exceeds a limit never ranks above one that holds, and higher
// sharpness is not rewarded.
#include "engine/request/ranking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/request/tune.h"
#include "engine/request/verdict/verdict.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

MethodRequest method(const std::string& id, std::optional<double> Ms = {}) {
    MethodRequest request{.method = id, .options = {}};
    if (Ms) request.options.set("Ms", *Ms);
    if (Ms && id == "robust") request.options.set("Mt", *Ms);
    return request;
}

TuningRequest request_for(const PlantModel& plant, std::vector<MethodRequest> methods) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = std::move(methods);
    request.evaluate.points = 0;
    return request;
}

const TuningEntry& at_rank(const TuningResult& result, std::size_t rank) {
    return result.controllers[static_cast<std::size_t>(result.ranking.at(rank))];
}

bool comes_to_rest(const Evaluation& evaluation) {
    const Performance& does = evaluation.performance;
    return does.setpoint.settling_time && does.load.recovery_time && does.setpoint.IAE && does.load.IAE;
}

// From the figures of the answer only, without its `standing`.
bool holds(const TuningEntry& entry, double rank_Ms) {
    const Evaluation& evaluation = *entry.evaluation;
    const Figure& Ms = evaluation.region ? evaluation.region->worst_Ms : evaluation.robustness.Ms;
    return evaluation.robustness.stable && comes_to_rest(evaluation) && Ms && *Ms <= 1.0001 * rank_Ms &&
           (!entry.asked_Ms || *Ms <= 1.01 * *entry.asked_Ms);
}

void expect_order(const TuningResult& result, double rank_Ms) {
    bool held = true;
    double excess = -std::numeric_limits<double>::infinity();
    for (std::size_t rank = 0; rank < result.ranking.size(); ++rank) {
        const TuningEntry& entry = at_rank(result, rank);
        SCOPED_TRACE(entry.title);
        ASSERT_TRUE(entry.standing);
        const bool holds_here = holds(entry, rank_Ms) && entry.standing->within;
        EXPECT_EQ(entry.standing->holds(), holds_here) << entry.standing->why;
        EXPECT_LE(holds_here, held) << "stands below one that does not hold";
        held = held && holds_here;
        if (!holds_here || !entry.standing->excess_percent) continue;
        EXPECT_GE(*entry.standing->excess_percent, excess);
        excess = *entry.standing->excess_percent;
    }
}

TEST(Ranking, SharpRowsDoNotOutrankTheOptimum) {
    auto result = tune(request_for(Fopdt{.K = 2, .T = 10, .L = 3}, {{.method = "all", .options = {}}}), {});
    ASSERT_TRUE(result);
    EXPECT_EQ(at_rank(*result, 0).title, "Robust optimum (PID)");
    EXPECT_THAT(result->ranking_by, HasSubstr("excess of the load IAE over the least at the same Ms"));
    expect_order(*result, 2);
    // By load IAE alone it ranked behind eight rows with Ms up to 2.
    int lower = 0;
    const double IAE = *at_rank(*result, 0).evaluation->performance.load.IAE;
    for (const TuningEntry& entry : result->controllers)
        lower += entry.evaluation && holds(entry, 2) && *entry.evaluation->performance.load.IAE < IAE;
    EXPECT_GT(lower, 5);
}

TEST(Ranking, ATableUnderATighterLimitFollowsFromOrderAndLeastLimit) {
    const auto ranked_under = [](double Ms) {
        TuningRequest request = request_for(Fopdt{.K = 2, .T = 10, .L = 3}, {{.method = "all", .options = {}}});
        request.evaluate.rank_Ms = Ms;
        return tune(request, {}).value();
    };
    const TuningResult wide = ranked_under(2), tight = ranked_under(1.6);
    EXPECT_EQ(wide.rank_Ms, 2);
    EXPECT_EQ(tight.rank_Ms, 1.6);
    std::vector<int> holds;
    for (const int index : wide.ranking) {
        const Standing& standing = *wide.controllers[static_cast<std::size_t>(index)].standing;
        if (standing.min_limit && *standing.min_limit <= 1.6) holds.push_back(index);
    }
    std::ranges::sort(holds, {},
                      [&](int index) { return wide.controllers[static_cast<std::size_t>(index)].standing->order; });
    ASSERT_GT(holds.size(), 3u);
    ASSERT_LT(holds.size(), wide.ranking.size());
    for (std::size_t rank = 0; rank < tight.ranking.size(); ++rank) {
        const TuningEntry& entry = at_rank(tight, rank);
        EXPECT_EQ(entry.standing->holds(), rank < holds.size()) << entry.title;
        EXPECT_EQ(entry.standing->group == StandingGroup::holds, entry.standing->why.empty());
        if (rank < holds.size()) {
            EXPECT_EQ(tight.ranking[rank], holds[rank]) << entry.title;
        }
    }
}

TEST(Ranking, TheOrderCountsEveryEntryOnceWhateverTheLimit) {
    const auto result = tune(request_for(Fopdt{.K = 1, .T = 10, .L = 3}, {{.method = "all", .options = {}}}), {});
    ASSERT_TRUE(result);
    std::vector<int> orders;
    for (const int index : result->ranking)
        orders.push_back(result->controllers[static_cast<std::size_t>(index)].standing->order);
    std::ranges::sort(orders);
    for (std::size_t i = 0; i < orders.size(); ++i) EXPECT_EQ(orders[i], static_cast<int>(i) + 1);
}

TEST(Ranking, TheEntryToShowFirstIsTheOneThatTheVerdictNames) {
    const auto result = tune(request_for(Fopdt{.K = 1, .T = 10, .L = 3}, {method("simc"), method("robust", 1.4)}), {});
    ASSERT_TRUE(result && result->proposed);
    EXPECT_EQ(*result->proposed, result->verdict.front().figures.at("entry"));
    // If the verdict names none, the first with a controller.
    std::vector<TuningEntry> entries(2);
    EXPECT_FALSE(verdict::proposed(entries, {}));
    entries[1].unjudged.emplace();
    EXPECT_EQ(verdict::proposed(entries, {}), 1);
}

/// Stable, at rest, with these peaks.
TuningEntry entry_with(double Ms, std::optional<double> worst_Ms = {}, std::optional<double> Ms_as_built = {}) {
    TuningEntry entry;
    entry.method = "robust";
    entry.Ms_limit = entry.asked_Ms = 1.4;
    Evaluation evaluation;
    evaluation.controller = IdealPid{.Kp = 1, .Ti = 1};
    evaluation.robustness.stable = true;
    evaluation.robustness.Ms = Figure(Ms);
    Performance& does = evaluation.performance;
    for (Figure* figure : {&does.setpoint.settling_time, &does.setpoint.IAE, &does.load.recovery_time, &does.load.IAE})
        *figure = Figure(1.0);
    if (worst_Ms) {
        evaluation.region.emplace();
        evaluation.region->stable_fraction = 1;
        evaluation.region->worst_Ms = Figure(*worst_Ms);
    }
    if (Ms_as_built) {
        entry.on_device.emplace();
        entry.on_device->loop = {evaluation.robustness, evaluation.performance, {}, evaluation.region};
        entry.on_device->loop.robustness.Ms = Figure(*Ms_as_built);
    }
    entry.evaluation = std::move(evaluation);
    return entry;
}

TEST(Ranking, AnOwnLimitHoldsInTheRankWhereTheVerdictSaysSo) {
    const AnalysedPlant subject = test::subject_of(Fopdt{.K = 1, .T = 10, .L = 3});
    const EvaluateOptions options;
    const RunControl control;
    const verdict::Context context{subject, options, {}, 0, nullptr, nullptr, {}, control};
    int held = 0, exceeded = 0;
    for (const double over : {0.0, 0.001, 0.0019, 0.0021, 0.005, 0.0099, 0.0101, 0.02}) {
        const double Ms = 1.4 * (1 + over);
        std::vector<TuningEntry> entries = {
            entry_with(Ms),          entry_with(1.3, Ms),       entry_with(Ms, 1.3),
            entry_with(1.4, {}, Ms), entry_with(1.3, 1.35, Ms), entry_with(1.3, Ms, 1.3)};
        ranked(entries, {2, true});
        verdict::judge(entries, context);
        for (std::size_t i = 0; i < entries.size(); ++i) {
            SCOPED_TRACE(testing::Message() << over << ", entry " << i);
            const auto above = std::ranges::find(entries[i].verdict, "above-limit", &verdict::Finding::code);
            EXPECT_EQ(entries[i].standing->within, above == entries[i].verdict.end());
            EXPECT_EQ(entries[i].standing->within, entries[i].standing->holds());
            EXPECT_EQ(*entries[i].standing->Ms, Ms) << "of the loop as it will run, wherever that is largest";
            // On the worst plant it is known to 1 %.
            EXPECT_EQ(entries[i].standing->within, over < (i == 1 || i == 5 ? 0.01 : 0.002));
            ++(entries[i].standing->within ? held : exceeded);
        }
    }
    EXPECT_GT(held, 10);
    EXPECT_GT(exceeded, 10);
}

TEST(Ranking, OnANonlinearPlantTheEquationsDecideWhatSettles) {
    // pH: a set-point step of 0.5 drives the sharper loops into a limit cycle, although their linearisation is well
    // damped.
    const NonlinearPlant pH{.states = {{"x", -3.16}},
                            .parameters = {{"V", 20.0}, {"Fa", 4.0}, {"Ca", 100.0}, {"Cb", 1000.0}, {"Kw", 0.01}},
                            .equations = {{"x", "(Fb*(Cb - x) - Fa*(Ca + x))/V"}},
                            .input = {.name = "Fb", .nominal = 0.386, .min = 0.0, .max = 1.0},
                            .output = "6 - log(sqrt(x^2/4 + Kw) - x/2)/log(10)",
                            .L = 0.2};
    auto request = request_for(pH, {method("simc"), method("ziegler_nichols_ultimate"), method("robust"),
                                    method("tyreus_luyben"), method("amigo"), method("lambda")});
    request.evaluate.setpoint_step = 0.5;
    request.evaluate.load_step = 0.01;
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    expect_order(*result, 2);
    EXPECT_TRUE(at_rank(*result, 0).standing->holds());
    const TuningEntry& simc = result->controllers[0];
    ASSERT_TRUE(simc.standing);
    EXPECT_LT(*simc.evaluation->robustness.Ms, 2);
    EXPECT_GT(*simc.evaluation->performance.setpoint.overshoot_percent, 100);
    EXPECT_FALSE(simc.standing->settles);
    EXPECT_THAT(simc.standing->why, HasSubstr("2 % of the set point"));
}

TEST(Ranking, TodaysSettingsAreHeldToTheLimitThatWasAskedOfTheDesign) {
    auto request = request_for(Fopdt{.K = 2, .T = 10, .L = 3}, {method("robust", 1.4)});
    request.baseline = IdealPid{.Kp = 1.5, .Ti = 8, .Td = 1, .filter = {FilterType::measurement_second_order, 0.1}};
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    const TuningEntry& today = result->controllers[1];
    ASSERT_LT(*today.evaluation->performance.load.IAE, *result->controllers[0].evaluation->performance.load.IAE);
    ASSERT_LT(*today.evaluation->robustness.Ms, 2);
    EXPECT_THAT(result->ranking, testing::ElementsAre(0, 1));
    EXPECT_FALSE(today.standing->within);
    EXPECT_FALSE(today.standing->excess_percent) << "one design needs no second search";
    EXPECT_EQ(result->ranking_by, "load IAE, among stable entries that settle with Ms <= 2, then the rest");
}

TEST(Ranking, ARowWithoutAnOptimumIsComparedAtTheNearestMs) {
    // Without dead time rules reach Ms = 1, where there is no optimum.
    const auto result =
        tune(request_for(Fopdt{.K = 1, .T = 5, .L = 0}, {method("lambda"), method("imc"), method("robust", 1.4)}), {});
    ASSERT_TRUE(result) << result.error().message;
    for (const TuningEntry& entry : result->controllers) {
        if (entry.evaluation) {
            EXPECT_TRUE(entry.standing->excess_percent) << entry.title;
        }
    }
    expect_order(*result, 2);
}

class AnyPlant {
public:
    explicit AnyPlant(unsigned seed) : random_(seed) {}

    PlantModel next() {
        const double K = log_uniform(0.1, 10), T = log_uniform(1, 30), L = log_uniform(0.1, 30);
        switch (std::uniform_int_distribution<int>(0, 6)(random_)) {
            case 0: return Fopdt{.K = K, .T = T, .L = L};
            case 1: return Sopdt{.K = K, .T1 = T, .T2 = log_uniform(1, 30), .L = L};
            case 2: return Ipdt{.K = K, .L = L};
            case 3: return Fopdt{.K = -K, .T = -T, .L = T * log_uniform(0.02, 0.5)};
            case 4: return TransferFunction{.num = {-L, 1}, .den = {T * T, 2 * T, 1}, .L = L};
            case 5: return Fopdt{.K = K, .T = T, .L = L, .uncertainty = {.K = FactorRange{0.7, log_uniform(1.1, 1.8)}}};
            default: return TransferFunction{.num = {K}, .den = {T * T, 0.4 * T, 1}, .L = L};
        }
    }
    double log_uniform(double low, double high) {
        return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random_));
    }

private:
    std::mt19937 random_;
};

TEST(Ranking, NoRowThatDoesNotHoldStandsAboveOneThatDoes) {
    AnyPlant any(17);
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(i);
        auto request =
            request_for(any.next(), {method("robust", any.log_uniform(1.15, 2.2)), method("arrieta_ms", 1.6),
                                     method("simc"), method("amigo"), method("ziegler_nichols_step"),
                                     method("ziegler_nichols_ultimate"), method("cohen_coon"), method("lambda")});
        request.baseline = IdealPid{.Kp = any.log_uniform(0.03, 10), .Ti = any.log_uniform(1, 100)};
        request.evaluate.rank_Ms = any.log_uniform(1.2, 3);
        if (i % 3 == 0) request.evaluate.horizon = any.log_uniform(50, 500);
        if (i % 4 == 0) request.evaluate.actuator = ActuatorLimits{-2, 2};
        const auto result = tune(request, {});
        if (result) expect_order(*result, *request.evaluate.rank_Ms);
    }
}

}  // namespace
}  // namespace tunewright
