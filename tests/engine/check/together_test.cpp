// What many loops say together: sources need a common time, causes that a neighbour cannot explain stay, cascades.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/check/together/plant_check.h"
#include "tests/engine/check/simulated_loop.h"

namespace tunewright::check {
namespace {

constexpr double kDay = 86400;

LoopCheck check_from(const Record& record, std::optional<double> start) {
    LoopQuestion question;
    question.record = record;
    question.u_range = {{0, 100}};
    question.start = start;
    return *check_loop(question, {});
}

/// A sticking loop and one that it disturbs, starting at these times.
std::vector<LoopCheck> source_and_neighbour(std::optional<double> first, std::optional<double> second) {
    LoopSetUp stick;
    stick.band = 4;
    stick.jump = 3;
    const Record source = simulated(stick, 11);
    std::vector<double> pushed;
    for (std::size_t i = 0; i < source.y.size(); ++i) pushed.push_back(2 * (source.y[i] - 50));
    LoopSetUp other;
    other.plant = {.K = 1, .T = 25, .L = 4};
    other.load = 0.03;
    std::vector<LoopCheck> loops{check_from(source, first), check_from(simulated(other, 12, pushed), second)};
    loops[0].tag = "FIC1";
    loops[1].tag = "LIC2";
    return loops;
}

PlantCheck plant_of(std::vector<LoopCheck>& loops) {
    std::vector<LoopCheck*> all;
    for (LoopCheck& loop : loops) all.push_back(&loop);
    return check_plant(all);
}

TEST(ChecksTogether, TheSourceIsTheOneThatLeads) {
    auto loops = source_and_neighbour(kDay, kDay);
    const PlantCheck plant = plant_of(loops);
    ASSERT_EQ(plant.clusters.size(), 1U);
    EXPECT_EQ(plant.clusters[0].source, 0U);
    EXPECT_EQ(loops[1].cause.verdict, Verdict::external);
    EXPECT_EQ(loops[1].action.code, ActionCode::find_source);
    EXPECT_EQ(std::ranges::find(plant.ranking, 1U, &Rank::loop)->after, 0U);
}

TEST(ChecksTogether, WithoutACommonTimeNoSourceIsNamed) {
    for (const auto& [first, second] : {std::pair<std::optional<double>, std::optional<double>>{kDay, 40 * kDay},
                                        {std::nullopt, std::nullopt},
                                        {kDay, std::nullopt}}) {
        auto loops = source_and_neighbour(first, second);
        const Verdict own = loops[1].cause.verdict;
        for (const Cluster& cluster : plant_of(loops).clusters) EXPECT_FALSE(cluster.source);
        EXPECT_EQ(loops[1].cause.verdict, own);
    }
}

/// Records that end hours apart still share the time that they share.
TEST(ChecksTogether, RecordsOfDifferentLengthsAreComparedOverTheirCommonTime) {
    auto loops = source_and_neighbour(kDay, kDay);
    LoopSetUp stick;
    stick.band = 4;
    stick.jump = 3;
    stick.rows = 4000;
    loops[0] = check_from(simulated(stick, 11), kDay);
    loops[0].tag = "FIC1";
    ASSERT_EQ(loops[0].cause.verdict, Verdict::stiction);
    EXPECT_LE(plant_of(loops).clusters.size(), 1U);
}

TEST(ChecksTogether, ALoopInManualStaysOne) {
    auto loops = source_and_neighbour(kDay, kDay);
    loops[1].cause.verdict = Verdict::manual;
    loops[1].cause.confidence = Confidence::sure;
    const PlantCheck plant = plant_of(loops);
    ASSERT_EQ(plant.clusters.size(), 1U);
    EXPECT_EQ(loops[1].cause.verdict, Verdict::manual);
}

TEST(ChecksTogether, ASecondJudgementChangesNothing) {
    auto loops = source_and_neighbour(kDay, kDay);
    plant_of(loops);
    const auto once = loops[1].cause;
    plant_of(loops);
    EXPECT_EQ(loops[1].cause.verdict, once.verdict);
    EXPECT_EQ(std::ranges::count(loops[1].cause.evidence, "moves-with-source", &Evidence::code), 1);
}

/// The gain is that of the oscillation, not of a lasting offset beside it.
TEST(ChecksTogether, AnOffsetIsNotGainedByEndingAnOscillation) {
    std::vector<LoopCheck> loops(2);
    for (LoopCheck& loop : loops) {
        loop.cause.verdict = Verdict::tight;
        loop.oscillation = {.found = true, .periods = {{.period = 50, .share = 1}}};
        loop.performance.variability = 0.35;
        loop.performance.mean_error = 0.3;
    }
    loops[1].performance.offset = loops[1].performance.mean_error = 5;
    const PlantCheck plant = plant_of(loops);
    const auto gain = [&](std::size_t i) {
        return std::ranges::find(plant.ranking, i, &Rank::loop)->gain.value_or(-1);
    };
    EXPECT_NEAR(gain(0), 0.24, 1e-9);
    EXPECT_LT(gain(1), 0.02);
}

LoopCheck with_means(std::vector<float> set_point, std::vector<float> output) {
    LoopCheck check;
    check.shape.from = 0;
    check.shape.to = 1000;
    check.shape.dated = true;
    check.shape.set_point = std::move(set_point);
    check.shape.output = std::move(output);
    return check;
}

TEST(ChecksTogether, ACascadeMovesOftenAndAsOne) {
    test::Random random(3);
    std::vector<float> noise(kShapeMeans), ramp(kShapeMeans);
    for (std::size_t i = 0; i < noise.size(); ++i) {
        noise[i] = float(normal(random));
        ramp[i] = float(i) - 0.5F * float(noise.size());
    }
    std::vector<LoopCheck> cascade{with_means({}, noise), with_means(noise, {})};
    const PlantCheck found = plant_of(cascade);
    ASSERT_EQ(found.cascades.size(), 1U);
    EXPECT_EQ(found.cascades[0].master, 0U);
    EXPECT_EQ(found.cascades[0].slave, 1U);
    std::vector<LoopCheck> ramps{with_means({}, ramp), with_means(ramp, {})};
    EXPECT_TRUE(plant_of(ramps).cascades.empty()) << "an operator ramps two loops at once";
}

TEST(ChecksTogether, WithoutClustersEachLoopIsRankedByItself) {
    auto loops = source_and_neighbour(kDay, kDay);
    const Verdict own = loops[1].cause.verdict;
    std::vector<LoopCheck*> all{&loops[0], &loops[1]};
    const PlantCheck plant = check_plant(all, false);
    EXPECT_TRUE(plant.clusters.empty());
    EXPECT_EQ(plant.ranking.size(), 2U);
    EXPECT_EQ(loops[1].cause.verdict, own);
}

TEST(ChecksTogether, MoneyOrdersBeforeShares) {
    std::vector<LoopCheck> loops(2);
    for (LoopCheck& loop : loops) {
        loop.cause.verdict = Verdict::tight;
        loop.oscillation = {.found = true, .periods = {{.period = 50, .share = 0.5}}};
        loop.performance.variability = loop.performance.mean_error = 1;
    }
    loops[1].oscillation.periods[0].share = 0.2;
    loops[1].weight = 3;
    EXPECT_EQ(plant_of(loops).ranking.front().loop, 1U);
    loops[0].weight = 30;
    EXPECT_EQ(plant_of(loops).ranking.front().loop, 0U);
}

}  // namespace
}  // namespace tunewright::check
