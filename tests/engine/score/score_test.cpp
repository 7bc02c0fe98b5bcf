// Scores against closed forms and properties.
#include <gtest/gtest.h>

#include "engine/score/rule_settings.h"
#include "engine/score/score.h"
#include "engine/tuning/registry.h"

namespace tunewright::score {
namespace {

Problem lag(const std::string& name, double L, double Ms, double lower) {
    return {.name = name, .plant = Fopdt{.K = 1, .T = 1, .L = L}, .Ms = Ms, .Mt = Ms, .upper = lower, .lower = lower};
}

/// IAE = Ti/Kp where the response does not change its sign.
const IdealPid kSlow{.Kp = 0.2, .Ti = 1};

Expected<Score> of(const std::vector<Problem>& problems, const SettingsFor& settings) {
    return score::score(problems, settings, {});
}

TEST(Score, TheRatioIsTheIaeOverTheBoundAndBrokenLimitsCountApart) {
    const std::vector<Problem> problems{lag("a", 1, 2, 2.5), lag("b", 1, 1.0001, 2.5), lag("c", 1, 2, 5)};
    const auto found = of(problems, [](const Problem&) { return kSlow; });
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kept, 2);
    EXPECT_EQ(found->limits_broken, 1);
    EXPECT_NEAR(found->problems[0].ratio, 2, 1e-6);
    EXPECT_EQ(found->problems[1].status, Status::limits_broken);
    EXPECT_NEAR(found->problems[2].ratio, 1, 1e-6);
    EXPECT_NEAR(*found->median_ratio, 1.5, 1e-6);
    ASSERT_EQ(found->profile.size(), 2u);
    EXPECT_NEAR(found->profile[0].share, 1.0 / 3, 1e-12);
    EXPECT_NEAR(found->profile[1].share, 2.0 / 3, 1e-12);
}

TEST(Score, UnstableLoopsAndMissingSettingsAreNoSolutions) {
    const std::vector<Problem> problems{lag("a", 1, 2, 2.5), lag("b", 2, 2, 2.5), lag("c", 0.5, 2, 2.5)};
    const auto found = of(problems, [](const Problem& problem) -> Expected<IdealPid> {
        if (problem.name == "b") return Error{ErrorKind::unsupported, "", "none"};
        return problem.name == "a" ? IdealPid{.Kp = 50, .Ti = 1} : kSlow;
    });
    ASSERT_TRUE(found);
    EXPECT_EQ(found->unstable, 1);
    EXPECT_EQ(found->no_settings, 1);
    EXPECT_EQ(found->problems[1].why, "none");
    EXPECT_EQ(found->profile.back().share, 1.0 / 3);
}

TEST(Score, TheRangeIsTheLongestRunWithoutAFailure) {
    std::vector<Problem> problems;
    for (const double L : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0}) problems.push_back(lag("L" + std::to_string(L), L, 4, 1));
    const auto found = of(problems, [&](const Problem& problem) {
        return problem.name == problems[1].name ? IdealPid{.Kp = 50, .Ti = 1} : kSlow;
    });
    ASSERT_TRUE(found && found->range);
    EXPECT_EQ(found->range->problems, 4);
    EXPECT_NEAR(found->range->tau_low, 0.5 / 1.5, 1e-9);
    EXPECT_NEAR(found->range->tau_high, 0.8, 1e-9);
}

TEST(Score, FormulasGiveTheFiguresOfTheBuiltInRules) {
    struct Rule {
        const char* id;
        MethodOptions given;
        const char *Kp, *Ti, *Td;
    };
    const auto with = [](const char* kind) {
        MethodOptions options;
        options.set("controller", std::string(kind));
        return options;
    };
    const Rule rules[] = {
        {"simc", with("PI"), "T/(K*2*L)", "min(T, 8*L)", ""},
        {"cohen_coon", with("PID"), "(4/3 + L/T/4)/(K*L/T)", "L*(32 + 6*L/T)/(13 + 8*L/T)", "4*L/(11 + 2*L/T)"},
        {"tyreus_luyben", with("PI"), "Ku/3.2", "2.2*Pu", ""}};
    std::vector<Problem> problems;
    for (const double L : {0.15, 0.5, 0.9}) {
        problems.push_back(lag("pi" + std::to_string(L), L, 3, 1));
        problems.push_back(problems.back());
        problems.back().structure = CertifiedStructure::pid_tied;
    }
    for (const Rule& rule : rules) {
        MethodOptions formulas;
        formulas.set("Kp", std::string(rule.Kp));
        formulas.set("Ti", std::string(rule.Ti));
        if (*rule.Td != 0) formulas.set("Td", std::string(rule.Td));
        const TuningMethod &built_in = *find_method(rule.id), &own = *find_method("formula");
        std::vector<Problem> own_kind;
        for (const Problem& problem : problems)
            if (designs(own, formulas, problem.structure)) own_kind.push_back(problem);
        ASSERT_EQ(own_kind.size(), 3u);
        for (const Problem& problem : own_kind) EXPECT_TRUE(designs(built_in, rule.given, problem.structure));
        const auto expected = of(own_kind, settings_by(built_in, rule.given, {})),
                   found = of(own_kind, settings_by(own, formulas, {}));
        ASSERT_TRUE(expected && found);
        for (std::size_t i = 0; i < own_kind.size(); ++i) {
            EXPECT_EQ(found->problems[i].status, expected->problems[i].status) << rule.id;
            EXPECT_NEAR(found->problems[i].ratio, expected->problems[i].ratio, 1e-9 * expected->problems[i].ratio);
        }
    }
}

}  // namespace
}  // namespace tunewright::score
