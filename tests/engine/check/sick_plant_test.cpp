// A plant of forty loops: ten with sticking valves, ten sluggish, ten tight, ten disturbed by a sticking neighbour.
// From their records to the work list, to causes, and to settings that hold Ms on the true plants.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/evaluation/evaluate.h"
#include "engine/request/check/ask_check.h"
#include "engine/tuning/limits.h"
#include "tests/engine/check/simulated_loop.h"

namespace tunewright::check {
namespace {

constexpr int kOfEach = 10;

struct SickLoop {
    LoopQuestion question;
    LoopSetUp truth;
    Verdict cause = Verdict::healthy;
    std::optional<std::size_t> neighbour;  ///< the loop that disturbs it
};

LoopSetUp drawn(test::Random& random) {
    LoopSetUp s;
    s.plant = {.K = random.uniform(0.8, 2), .T = random.uniform(15, 40), .L = std::round(random.uniform(3, 6))};
    s.load = random.uniform(0.08, 0.15);
    s.noise = s.plant.K * random.uniform(0.02, 0.05);
    s.set_point_moves = 4;
    s.set_point_size = 4;
    s.rows = 3000;
    return s;
}

SickLoop made(const char* name, int k, Verdict cause, const LoopSetUp& s, const std::vector<double>& further = {}) {
    SickLoop loop;
    loop.truth = s;
    loop.cause = cause;
    loop.question.tag = std::string(name) + std::to_string(k);
    loop.question.record = simulated(s, std::uint64_t(1000 * int(cause) + k), further);
    loop.question.u_range = {{0, 100}};
    loop.question.start = 1.8e9;
    return loop;
}

/// What the neighbour's error does to this loop's load: the sticking loop's measurement, about its set point, as % of
/// u.
std::vector<double> disturbance_of(const SickLoop& loop, double share) {
    std::vector<double> out;
    const Record& record = loop.question.record;
    for (std::size_t i = 0; i < record.y.size(); ++i) out.push_back(share * (record.y[i] - record.r[i]));
    return out;
}

std::vector<SickLoop> sick_plant() {
    std::vector<SickLoop> plant;
    test::Random random(3);
    for (int k = 0; k < kOfEach; ++k) {
        LoopSetUp s = drawn(random);
        s.band = random.uniform(3, 7);
        s.jump = s.band * random.uniform(0.5, 1);
        s.set_point_moves = 0;
        plant.push_back(made("stick", k, Verdict::stiction, s));
    }
    for (int k = 0; k < kOfEach; ++k) {
        LoopSetUp s = drawn(random);
        s.slowness = random.uniform(10, 18);
        plant.push_back(made("slow", k, Verdict::sluggish, s));
    }
    for (int k = 0; k < kOfEach; ++k) {
        LoopSetUp s = drawn(random);
        s.Ti = std::min(s.plant.T, 8 * s.plant.L);
        s.Kp = ultimate_gain(s.plant, s.Ti, s.step) / random.uniform(1.03, 1.08);
        s.noise *= 0.3;
        plant.push_back(made("tight", k, Verdict::tight, s));
    }
    for (int k = 0; k < kOfEach; ++k) {
        LoopSetUp s = drawn(random);
        s.set_point_moves = 0;
        s.load = 0.03;
        const auto source = std::size_t(k % 3);  // three of the sticking loops disturb ten others
        plant.push_back(made("hit", k, Verdict::external, s, disturbance_of(plant[source], 2 / s.plant.K)));
        plant.back().neighbour = source;
    }
    return plant;
}

const CheckResult& result() {
    static const CheckResult found = [] {
        CheckQuestion question;
        for (const SickLoop& loop : sick_plant()) question.loops.push_back(loop.question);
        return *ask_check(question, {});
    }();
    return found;
}

TEST(SickPlant, TheCausesAreRight) {
    const auto plant = sick_plant();
    std::map<Verdict, int> right;
    int sure_and_wrong = 0;
    for (std::size_t i = 0; i < plant.size(); ++i) {
        const Cause& cause = result().loops[i].cause;
        const bool ok = cause.verdict == plant[i].cause ||
                        (plant[i].cause == Verdict::stiction && cause.verdict == Verdict::backlash);
        right[plant[i].cause] += ok ? 1 : 0;
        sure_and_wrong += !ok && cause.confidence == Confidence::sure ? 1 : 0;
    }
    EXPECT_GE(right[Verdict::stiction], 9);
    EXPECT_GE(right[Verdict::sluggish], 9);
    EXPECT_GE(right[Verdict::tight], 9);
    EXPECT_GE(right[Verdict::external], 9);
    EXPECT_EQ(sure_and_wrong, 0);
}

TEST(SickPlant, DisturbedLoopsComeAfterTheirSource) {
    const auto plant = sick_plant();
    int together = 0, after = 0;
    EXPECT_LE(result().plant.clusters.size(), 4) << "loops that only happen to have one period are no group";
    for (std::size_t i = 0; i < plant.size(); ++i) {
        if (!plant[i].neighbour) continue;
        for (const Cluster& cluster : result().plant.clusters)
            if (std::ranges::count(cluster.loops, i) && std::ranges::count(cluster.loops, *plant[i].neighbour))
                ++together;
        for (const Rank& rank : result().plant.ranking)
            if (rank.loop == i && rank.after == plant[i].neighbour) ++after;
    }
    EXPECT_GE(together, 9);
    EXPECT_GE(after, 9);
}

TEST(SickPlant, TheWorkListBeginsWithTheSourcesAndEndsWithTheDisturbed) {
    const auto plant = sick_plant();
    const auto& ranking = result().plant.ranking;
    ASSERT_EQ(ranking.size(), plant.size());
    std::set<std::size_t> once;
    for (const Rank& rank : ranking) once.insert(rank.loop);
    EXPECT_EQ(once.size(), plant.size());
    std::set<std::size_t> first;
    for (std::size_t k = 0; k < 3; ++k) first.insert(ranking[k].loop);
    EXPECT_EQ(first, (std::set<std::size_t>{0, 1, 2})) << "the three valves that disturb ten other loops";
    int last = 0;
    for (std::size_t k = 28; k < ranking.size(); ++k) last += plant[ranking[k].loop].neighbour ? 1 : 0;
    EXPECT_GE(last, 9);
}

/// Of a few of each kind: identification takes seconds.
TEST(SickPlant, NewSettingsHoldMsOnTheTruePlants) {
    const auto plant = sick_plant();
    CheckQuestion question;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < plant.size(); ++i) {
        if (i % kOfEach > 3) continue;
        question.loops.push_back(plant[i].question);
        places.push_back(i);
    }
    question.settings = true;
    const auto asked = ask_check(question, {});
    ASSERT_TRUE(asked);
    int designed = 0, tests = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const CheckedLoop& loop = asked->loops[k];
        const SickLoop& true_loop = plant[places[k]];
        if (true_loop.neighbour) {
            EXPECT_FALSE(loop.cure) << loop.tag << ": a disturbance is not tuned away";
            continue;
        }
        if (true_loop.cause == Verdict::stiction) {
            ASSERT_TRUE(loop.cure) << loop.tag;
            EXPECT_TRUE(loop.cure->valve) << loop.tag;
            EXPECT_FALSE(loop.cure->settings || loop.cure->test) << loop.tag << ": a valve is not tuned away";
            continue;
        }
        ASSERT_TRUE(loop.cure) << loop.tag;
        EXPECT_TRUE(loop.cure->settings.has_value() != loop.cure->test.has_value());
        if (loop.cure->test) {
            ++tests;
            EXPECT_GT(loop.cure->test->size, 0);
            EXPECT_GT(loop.cure->test->hold, 2 * true_loop.truth.plant.L);
            continue;
        }
        ++designed;
        const auto truth = evaluate(PlantModel(Plant(true_loop.truth.plant)), Controller(*loop.cure->settings), {});
        ASSERT_TRUE(truth);
        ASSERT_TRUE(truth->robustness.stable) << loop.tag;
        EXPECT_LE(*truth->robustness.Ms, limits::kDefaultMs * 1.02) << loop.tag;
    }
    EXPECT_EQ(designed + tests, 8);
    EXPECT_GE(designed, 4);
}

}  // namespace
}  // namespace tunewright::check
