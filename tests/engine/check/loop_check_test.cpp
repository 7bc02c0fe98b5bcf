// The check of one loop: causes of simulated loops, what a poor record is told, and figures against their definitions.
#include "engine/check/loop_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "tests/engine/check/simulated_loop.h"

namespace tunewright::check {
namespace {

LoopQuestion question_about(Record record) {
    LoopQuestion question;
    question.tag = "loop";
    question.record = std::move(record);
    question.u_range = {{0, 100}};
    return question;
}

LoopCheck checked(const LoopQuestion& question) {
    auto found = check_loop(question, {});
    EXPECT_TRUE(found);
    return *found;
}

LoopCheck checked(const Record& record) { return checked(question_about(record)); }

bool has_remark(const LoopCheck& check, const std::string& code) {
    return std::ranges::any_of(check.quality.remarks, [&](const Warning& remark) { return remark.code == code; });
}

LoopSetUp drawn_loop(test::Random& random) {
    LoopSetUp s;
    s.plant = {.K = random.uniform(0.5, 2.5), .T = random.log_uniform(6, 60), .L = std::round(random.uniform(2, 8))};
    s.slowness = random.uniform(1, 2);
    s.load = random.uniform(0.08, 0.3);
    s.noise = s.plant.K * random.uniform(0.02, 0.1);
    s.bias = random.uniform(1, 4) * (random.one_in(2) ? 1 : -1);
    s.y_grid = 0.005;
    return s;
}

struct Tally {
    int right = 0, sure_and_wrong = 0, loops = 0;
};

/// `accepted`: the verdicts that are right.
Tally tally(const std::vector<Verdict>& accepted, int loops, std::uint64_t seed,
            const std::function<void(LoopSetUp&, test::Random&)>& spoil) {
    Tally out;
    for (int i = 0; i < loops; ++i) {
        test::Random random(seed + std::uint64_t(i));
        LoopSetUp s = drawn_loop(random);
        spoil(s, random);
        const LoopCheck check = checked(simulated(s, seed + 1000 + std::uint64_t(i)));
        const bool right = std::ranges::find(accepted, check.cause.verdict) != accepted.end();
        ++out.loops;
        out.right += right ? 1 : 0;
        out.sure_and_wrong += !right && check.cause.confidence == Confidence::sure ? 1 : 0;
    }
    return out;
}

TEST(LoopCheck, AStickingValveIsFoundWithItsSize) {
    int right = 0, sized = 0, loops = 0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        test::Random random(seed);
        LoopSetUp s = drawn_loop(random);
        s.band = random.uniform(2, 8);
        s.jump = s.band * random.uniform(0.4, 1);
        const LoopCheck check = checked(simulated(s, seed));
        ++loops;
        if (check.cause.verdict != Verdict::stiction && check.cause.verdict != Verdict::backlash) continue;
        ++right;
        ASSERT_TRUE(check.cause.size);
        sized += std::abs(*check.cause.size / s.band - 1) < 0.3 ? 1 : 0;
        EXPECT_EQ(check.action.code, ActionCode::repair_valve);
        EXPECT_EQ(check.action.owner, Owner::instruments);
    }
    EXPECT_GE(right, 14) << "of " << loops;
    EXPECT_GE(sized, right * 8 / 10);
}

TEST(LoopCheck, CausesOfSimulatedLoops) {
    using enum Verdict;
    const std::map<std::string, std::pair<std::vector<Verdict>, std::function<void(LoopSetUp&, test::Random&)>>> kinds =
        {
            {"healthy", {{healthy}, [](LoopSetUp&, test::Random&) {}}},
            {"tight",
             {{tight},
              [](LoopSetUp& s, test::Random& random) {
                  s.Ti = std::min(s.plant.T, 4 * (1 + s.slowness) * s.plant.L);
                  s.Kp = ultimate_gain(s.plant, s.Ti, s.step) / random.uniform(1.02, 1.08);
                  s.noise *= 0.3;
              }}},
            {"external",
             {{external},
              [](LoopSetUp& s, test::Random& random) {
                  s.sine = random.uniform(2, 5);
                  s.sine_period = std::min(s.plant.T, 4 * (1 + s.slowness) * s.plant.L) * random.uniform(1.5, 5);
              }}},
            {"quantised",
             {{quantised}, [](LoopSetUp& s, test::Random&) { s.y_grid = 2 * (s.noise + 0.2 * s.plant.K * s.load); }}},
            {"manual", {{manual}, [](LoopSetUp& s, test::Random&) { s.manual_from = 0.4; }}},
            {"saturation", {{saturation}, [](LoopSetUp& s, test::Random&) { s.bias = -60; }}},
        };
    Tally all;
    for (const auto& [name, kind] : kinds) {
        const Tally found = tally(kind.first, 8, 40, kind.second);
        EXPECT_GE(found.right, 7) << name;
        all.sure_and_wrong += found.sure_and_wrong;
        all.loops += found.loops;
    }
    EXPECT_LE(all.sure_and_wrong, all.loops / 50);
}

TEST(LoopCheck, HealthyLoopsAreNotCalledFaulty) {
    using enum Verdict;
    const Tally found = tally({healthy, undetermined}, 40, 900, [](LoopSetUp& s, test::Random& random) {
        if (random.one_in(3)) s.set_point_moves = 3;
    });
    EXPECT_GE(found.right, 39);
    EXPECT_EQ(found.sure_and_wrong, 0);
}

/// The units of the record do not matter: neither those of time, nor those of the measurement.
TEST(LoopCheck, OtherUnitsGiveTheSameVerdict) {
    LoopSetUp s;
    s.band = 4;
    s.jump = 3;
    const Record record = simulated(s, 7);
    const LoopCheck check = checked(record);
    Record other = record;
    for (double& t : other.t) t = 100 + t / 3600;
    for (double* column : {other.y.data(), other.r.data()})
        for (std::size_t i = 0; i < other.t.size(); ++i) column[i] = 32 + 1.8 * column[i];
    const LoopCheck again = checked(other);
    EXPECT_EQ(again.cause.verdict, check.cause.verdict);
    ASSERT_TRUE(check.oscillation.found && again.oscillation.found);
    EXPECT_NEAR(3600 * again.oscillation.periods[0].period / check.oscillation.periods[0].period, 1, 1e-3);
    EXPECT_NEAR(again.performance.variability / check.performance.variability, 1.8, 1e-6);
}

TEST(LoopCheck, APoorRecordIsToldWhatItLacks) {
    LoopSetUp s;
    s.rows = 120;
    const LoopCheck brief = checked(simulated(s, 1));
    EXPECT_EQ(brief.cause.verdict, Verdict::insufficient_data);
    EXPECT_FALSE(brief.cause.why_open.empty());
    EXPECT_EQ(brief.action.code, ActionCode::record_again);
    s.rows = 2000;
    Record gaps = simulated(s, 1);
    for (std::size_t i = 0; i < gaps.y.size(); ++i)
        if (i % 5 != 0) gaps.y[i] = NAN;
    const LoopCheck missing = checked(gaps);
    EXPECT_EQ(missing.cause.verdict, Verdict::insufficient_data);
    EXPECT_NEAR(missing.quality.missing, 0.8, 1e-9);
}

TEST(LoopCheck, AConstantColumnIsAFindingAndNoError) {
    Record record = simulated({}, 3);
    std::ranges::fill(record.u, 42.0);
    EXPECT_EQ(checked(record).cause.verdict, Verdict::manual);
    record = simulated({}, 3);
    std::ranges::fill(record.y, 17.0);
    EXPECT_EQ(checked(record).cause.verdict, Verdict::frozen);
    record.u.pop_back();
    LoopQuestion question;
    question.record = record;
    const auto refused = check_loop(question, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "record/u");
}

/// No verdict depends on the order of the rows, and rows of equal time count once.
TEST(LoopCheck, RowsInAnyOrderGiveTheSame) {
    const Record record = simulated({}, 5);
    Record turned = record;
    for (auto* column : {&turned.t, &turned.y, &turned.u, &turned.r}) std::ranges::reverse(*column);
    const LoopCheck a = checked(record), b = checked(turned);
    EXPECT_EQ(a.cause.verdict, b.cause.verdict);
    EXPECT_EQ(a.performance.variability, b.performance.variability);
    EXPECT_EQ(a.performance.travel.value_or(-1), b.performance.travel.value_or(-2));
}

TEST(LoopCheck, TravelAndReversalsAreThoseOfTheirDefinition) {
    Record record;
    for (int i = 0; i < 3600; ++i) {
        record.t.push_back(i);
        record.y.push_back(50 + std::sin(0.05 * i));
        record.r.push_back(50);
        record.u.push_back(50 + 10 * ((i / 100) % 2));  // 35 moves of 10 %
    }
    const LoopCheck check = checked(record);
    EXPECT_NEAR(check.performance.travel.value_or(0), 35 * 0.1, 0.01);
    EXPECT_NEAR(check.performance.reversals.value_or(0), 34, 0.1);
}

TEST(LoopCheck, AMeasurementAtTheEndOfItsRangeComesBeforeEveryCause) {
    LoopSetUp s;
    s.band = 4;
    s.jump = 3;
    Record record = simulated(s, 7);
    std::vector<double> sorted = record.y;
    std::ranges::sort(sorted);
    const double low = 0, top = sorted[sorted.size() * 9 / 10];
    for (double& y : record.y) y = std::min(y, top);
    LoopQuestion question = question_about(record);
    EXPECT_FALSE(checked(question).quality.at_limit);
    question.y_range = {{low, top}};
    const LoopCheck check = checked(question);
    ASSERT_TRUE(check.quality.at_limit);
    EXPECT_GE(*check.quality.at_limit, 0.1);
    EXPECT_TRUE(has_remark(check, "measurement-at-limit"));
    EXPECT_EQ(check.cause.verdict, Verdict::insufficient_data);
    EXPECT_EQ(check.action.code, ActionCode::check_range);
    EXPECT_EQ(check.action.owner, Owner::instruments);
    EXPECT_NEAR(*check.performance.variability_share, check.performance.variability / (top - low), 1e-12);
    question.y_range = {{0, 200}};
    EXPECT_EQ(*checked(question).quality.at_limit, 0);
    EXPECT_EQ(checked(question).cause.verdict, checked(record).cause.verdict);
}

TEST(LoopCheck, GivenSettingsAreUsedUnlessTheRecordShowsOthers) {
    int silent = 0, told = 0;
    constexpr int kLoops = 12;
    for (std::uint64_t seed = 300; seed < 300 + kLoops; ++seed) {
        test::Random random(seed);
        LoopSetUp s = drawn_loop(random);
        const double tau = s.slowness * s.plant.L;
        s.Kp = s.plant.T / (s.plant.K * (tau + s.plant.L));
        s.Ti = std::min(s.plant.T, 4 * (tau + s.plant.L));
        LoopQuestion question = question_about(simulated(s, seed));
        const auto law_with = [&](double gain, double Ti) {
            question.controller = ParallelPid{.Kp = gain, .Ki = gain / Ti};
            return checked(question);
        };
        const LoopCheck right = law_with(s.Kp, s.Ti);
        EXPECT_TRUE(right.law.given);
        silent += has_remark(right, "controller-differs") ? 0 : 1;
        EXPECT_DOUBLE_EQ(right.law.Ti, s.Ti);
        const LoopCheck gain = law_with(2 * s.Kp, s.Ti), minus = law_with(-s.Kp, s.Ti), Ti = law_with(s.Kp, 3 * s.Ti);
        for (const LoopCheck* check : {&gain, &minus, &Ti}) {
            told += has_remark(*check, "controller-differs") ? 1 : 0;
            EXPECT_NE(check->law.given, has_remark(*check, "controller-differs"));
        }
    }
    EXPECT_EQ(silent, kLoops);
    EXPECT_GE(told, 3 * kLoops * 9 / 10);
}

TEST(LoopCheck, SentencesHaveTheUnitsOfTheRecord) {
    LoopSetUp s;
    s.band = 4;
    s.jump = 3;
    LoopQuestion question = question_about(simulated(s, 7));
    const auto sentences = [&] {
        const LoopCheck check = checked(question);
        std::string all = check.action.detail;
        for (const Evidence& evidence : check.cause.evidence) all += " " + evidence.detail;
        return all;
    };
    EXPECT_NE(sentences().find(" of the output's 0 to 100."), std::string::npos) << sentences();
    question.units = {"min", "degC", "mA"};
    EXPECT_NE(sentences().find(" min and a regularity"), std::string::npos) << sentences();
    EXPECT_NE(sentences().find(" mA."), std::string::npos) << sentences();
    EXPECT_EQ(sentences().find("output's 0"), std::string::npos) << sentences();
}

TEST(LoopCheck, ALevelIsJudgedOnlyIfItMustBeHeld) {
    LoopSetUp slow;
    slow.slowness = 16;
    slow.set_point_moves = 4;
    LoopQuestion question = question_about(simulated(slow, 4));
    EXPECT_TRUE(checked(question).performance.harris);
    EXPECT_EQ(checked(question).cause.verdict, Verdict::sluggish);
    question.kind = LoopKind::level;
    EXPECT_FALSE(checked(question).performance.harris);
    question.averaging = false;
    EXPECT_TRUE(checked(question).performance.harris);
    EXPECT_EQ(checked(question).cause.verdict, Verdict::sluggish);
    question.averaging = true;
    EXPECT_FALSE(checked(question).performance.harris);
    EXPECT_NE(checked(question).cause.verdict, Verdict::sluggish);
}

}  // namespace
}  // namespace tunewright::check
