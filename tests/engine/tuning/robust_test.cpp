// Robust design: properties that hold for any plant, the refusals, and the small solvers that it uses.
#include "engine/tuning/robust/robust.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/evaluation/evaluate.h"
#include "engine/number_text.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright {
namespace {

MethodOptions with(std::initializer_list<std::pair<const char*, OptionValue>> values) {
    MethodOptions options;
    for (const auto& [path, value] : values) options.set(path, value);
    return options;
}

Expected<TunedController> design(const Plant& plant, const MethodOptions& options, const RunControl& control = {}) {
    const auto linear = LinearPlant::make(plant);
    EXPECT_TRUE(linear.has_value());
    return robust_method().tune(TuningProblem{plant, *linear, std::nullopt}, options, control);
}

Evaluation evaluated(const Plant& plant, const IdealPid& pid) {
    EvaluateOptions options;
    options.points = 0;
    auto evaluation = evaluate(plant, pid, options);
    EXPECT_TRUE(evaluation.has_value());
    return *evaluation;
}

TEST(Robust, TimeScalesTiAndTdAndLeavesKp) {
    const auto base = design(Fopdt{.K = 2, .T = 3, .L = 1}, {});
    ASSERT_TRUE(base.has_value());
    for (const double a : {1e-9, 1e-5, 1e6, 1e12}) {
        const auto scaled = design(Fopdt{.K = 2, .T = 3 * a, .L = a}, {});
        ASSERT_TRUE(scaled.has_value());
        EXPECT_NEAR(scaled->controller.Kp / base->controller.Kp, 1, 1e-3);
        EXPECT_NEAR(scaled->controller.Ti / base->controller.Ti / a, 1, 1e-3);
        EXPECT_NEAR(scaled->controller.Td / base->controller.Td / a, 1, 1e-3);
    }
}

TEST(Robust, HugeGainsAndDistantTimeScalesChangeNothingElse) {
    const auto base = design(Fopdt{.K = 1, .T = 1, .L = 1}, {}), loud = design(Fopdt{.K = 1e25, .T = 1, .L = 1}, {});
    ASSERT_TRUE(base.has_value() && loud.has_value());
    EXPECT_NEAR(loud->controller.Kp * 1e25 / base->controller.Kp, 1, 1e-4);
    // T/L = 1e9 is an integrator to any controller.
    const auto lag = design(Fopdt{.K = 1e9, .T = 1e9, .L = 1}, {}), integrator = design(Ipdt{.K = 1, .L = 1}, {});
    ASSERT_TRUE(lag.has_value() && integrator.has_value());
    EXPECT_NEAR(lag->controller.Kp / integrator->controller.Kp, 1, 1e-2);
    EXPECT_NEAR(lag->controller.Ti / integrator->controller.Ti, 1, 3e-2);
}

TEST(Robust, GainDividesKpWithItsSign) {
    const auto base = design(Sopdt{.K = 1, .T1 = 4, .T2 = 1, .L = 1}, {});
    const auto scaled = design(Sopdt{.K = -50, .T1 = 4, .T2 = 1, .L = 1}, {});
    ASSERT_TRUE(base.has_value() && scaled.has_value());
    EXPECT_NEAR(scaled->controller.Kp * -50 / base->controller.Kp, 1, 1e-5);
    EXPECT_NEAR(scaled->controller.Ti / base->controller.Ti, 1, 1e-4);
}

TEST(Robust, ARelaxedLimitNeverCostsMore) {
    const Plant plant = Sopdt{.K = 1, .T1 = 10, .T2 = 3, .L = 2};
    double last = INFINITY;
    for (const double M : {1.1, 1.2, 1.4, 1.7, 2.0, 3.0}) {
        const auto tuned = design(plant, with({{"Ms", M}, {"Mt", M}}));
        ASSERT_TRUE(tuned.has_value()) << M;
        const auto e = evaluated(plant, tuned->controller);
        EXPECT_LE(std::max(*e.robustness.Ms, *e.robustness.Mt), M * (1 + 2e-5)) << M;
        EXPECT_LT(*e.performance.load.IAE, last * (1 + 1e-3)) << M;
        last = *e.performance.load.IAE;
    }
}

TEST(Robust, EachObjectiveWinsAtItsOwnMeasure) {
    const Plant plant = Fopdt{.K = 1, .T = 5, .L = 1};
    const auto figures = [&](const char* objective) {
        const auto tuned = design(plant, with({{"objective", std::string(objective)}}));
        EXPECT_TRUE(tuned.has_value());
        return evaluated(plant, tuned->controller);
    };
    const auto load = figures("load_iae"), ie = figures("load_ie"), setpoint = figures("setpoint_iae"),
               both = figures("weighted");
    const auto ratio = [](const Evaluation& e) {
        const auto& c = std::get<IdealPid>(e.controller);
        return c.Ti / c.Kp;
    };
    for (const auto* other : {&ie, &setpoint, &both})
        EXPECT_LE(*load.performance.load.IAE, *other->performance.load.IAE * (1 + 1e-4));
    for (const auto* other : {&load, &setpoint, &both}) EXPECT_LE(ratio(ie), ratio(*other) * (1 + 1e-4));
    for (const auto* other : {&load, &ie, &both})
        EXPECT_LE(*setpoint.performance.setpoint.IAE, *other->performance.setpoint.IAE * (1 + 1e-4));
    const auto mean = [&](const Evaluation& e) {
        return *e.performance.load.IAE / *load.performance.load.IAE +
               *e.performance.setpoint.IAE / *setpoint.performance.setpoint.IAE;
    };
    EXPECT_LE(mean(both), std::min({mean(load), mean(ie), mean(setpoint)}) * (1 + 1e-3));
}

TEST(Robust, MksIsKept) {
    const Plant plant = Fopdt{.K = 1, .T = 5, .L = 1};
    const auto tuned = design(plant, with({{"Mks", 6.0}}));
    ASSERT_TRUE(tuned.has_value()) << tuned.error().message;
    const auto e = evaluated(plant, tuned->controller);
    EXPECT_LE(*e.robustness.Mks, 6 * (1 + 2e-5));
    EXPECT_LE(*e.robustness.Ms, 1.4 * (1 + 2e-5));
}

TEST(Robust, ATightMksIsMetAtTheCheapestOfItsValleys) {
    // The published gridding covers the whole plane; the fast search must not end in a worse local optimum.
    const Plant plant = Fopdt{.K = 2, .T = 3, .L = 1};
    const auto fast = design(plant, with({{"Mks", 2.0}})),
               grid = design(plant, with({{"Mks", 2.0}, {"search", std::string("grid")}}));
    ASSERT_TRUE(fast.has_value() && grid.has_value());
    EXPECT_LE(*evaluated(plant, fast->controller).performance.load.IAE,
              1.001 * *evaluated(plant, grid->controller).performance.load.IAE);
    EXPECT_LE(*evaluated(plant, fast->controller).robustness.Mks, 2 * (1 + 2e-5));
}

namespace {

/// The smallest feasible limit that a refusal states; 0 if it states none.
double cure_of(const Error& refusal) {
    const auto Ms = refusal.cure.find("Ms"), Mt = refusal.cure.find("Mt");
    return Ms != refusal.cure.end() && Mt != refusal.cure.end() && Ms->second == Mt->second ? Ms->second : 0;
}

}  // namespace

TEST(Robust, UnstablePlantsHaveASmallestPeakThatWorks) {
    // e^(-Ls)/(s - 1) needs M of about 1.22, 1.34, 1.57, 1.82 for L = 0.05, 0.1, 0.2, 0.3.
    for (const auto& [L, min] : {std::pair{0.2, 1.57}, {0.3, 1.82}}) {
        const Plant plant = Fopdt{.K = -1, .T = -1, .L = L};
        const auto below = design(plant, with({{"Ms", min * 0.97}, {"Mt", min * 0.97}}));
        ASSERT_FALSE(below.has_value()) << L;
        EXPECT_EQ(below.error().kind, ErrorKind::no_feasible_controller);
        const double named = cure_of(below.error());
        EXPECT_NEAR(named, min * 1.01, 0.02 * min) << below.error().message;
        EXPECT_TRUE(design(plant, with({{"Ms", named}, {"Mt", named}})).has_value())
            << "the limit that the refusal names must work";
        EXPECT_NE(below.error().message.find("Ms = Mt = " + text(named)), std::string::npos) << below.error().message;
    }
}

TEST(Robust, BehindTwoIntegratorsTheSmallestPeakIsThatOfTheIntegratorsAlone) {
    // Each plant approaches K/s^2 at frequencies far below those of its lags and its dead time. For K/s^2 a PD with its
    // filter, which no integral action improves, has peaks of at least 1.3169 (from an independent sweep over the gain
    // on a grid).
    constexpr double kLeast = 1.3169;
    for (const Plant& plant : {Plant(Zpk{.K = 1, .zeros = {}, .poles = {0.0, 0.0}, .L = 0.02}),
                               Plant(Zpk{.K = 9.33, .zeros = {}, .poles = {0.0, 0.0, -6.166}, .L = 0.01936}),
                               Plant(Zpk{.K = 75.6, .zeros = {}, .poles = {0.0, 0.0, -17.8, -2.18}, .L = 0.0556})}) {
        const auto below = design(plant, with({{"Ms", kLeast * 0.99}, {"Mt", kLeast * 0.99}}));
        ASSERT_FALSE(below.has_value());
        EXPECT_EQ(below.error().kind, ErrorKind::no_feasible_controller) << below.error().message;
        const double named = cure_of(below.error());
        EXPECT_GE(named, kLeast) << below.error().message;
        EXPECT_LE(named, kLeast * 1.03) << below.error().message;
        EXPECT_TRUE(design(plant, with({{"Ms", named}, {"Mt", named}})).has_value()) << named;
    }
}

TEST(Robust, SaysWhenNothingStabilises) {
    const auto refused = design(Fopdt{.K = -1, .T = -1, .L = 1.5}, {});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, ErrorKind::unstable_plant);
}

TEST(Robust, SaysWhenTheOptimumHasNoEnd) {
    const auto kind = [](const Plant& plant, const MethodOptions& options) {
        const auto tuned = design(plant, options);
        return tuned ? std::string("a design") : std::string(to_string(tuned.error().kind));
    };
    EXPECT_EQ(kind(Fopdt{.K = 1, .T = 1, .L = 0}, with({{"controller", std::string("PI")}})), "unbounded-optimum");
    EXPECT_EQ(kind(Fopdt{.K = 1, .T = 1, .L = 0}, with({{"filter/Tf_over_Td", 0.1}})), "unbounded-optimum");
    EXPECT_EQ(kind(Sopdt{.K = 1, .T1 = 3, .T2 = 1, .L = 0}, with({{"filter/Tf_over_Td", 0.1}})), "unbounded-optimum");
    EXPECT_EQ(kind(Sopdt{.K = 1, .T1 = 3, .T2 = 1, .L = 0}, with({{"filter/Tf_over_Td", 0.25}})), "a design");
    EXPECT_EQ(kind(TransferFunction{{1, 2}, {1, 1}, 0}, {}), "unbounded-optimum")
        << "pole excess 0 needs Mks, a filter does not help";
    EXPECT_EQ(kind(Ipdt{.K = 1, .L = 0}, {}), "unbounded-optimum");
    EXPECT_EQ(kind(Ipdt{.K = 1, .L = 0}, with({{"filter/Tf", 0.1}})), "a design");
    EXPECT_EQ(kind(Fopdt{.K = 1, .T = 1, .L = 0}, {}), "a design") << "the default filter is fixed there";
}

TEST(Robust, DefaultFilterFollowsTheContract) {
    const auto filter = [](const Plant& plant) { return design(plant, {})->controller; };
    const IdealPid delayed = filter(Fopdt{.K = 1, .T = 2, .L = 1});
    EXPECT_NEAR(delayed.filter.Tf, 0.1 * delayed.Td, 1e-12);
    EXPECT_NEAR(filter(Sopdt{.K = 1, .T1 = 3, .T2 = 1, .L = 0}).filter.Tf, 0.05 * 4, 1e-12);
    const Plant plant = Sopdt{.K = 1, .T1 = 3, .T2 = 1, .L = 0.01};
    const auto identified = robust_method().tune(TuningProblem{plant, *LinearPlant::make(plant), 0.05}, {}, {});
    ASSERT_TRUE(identified.has_value());
    EXPECT_NEAR(identified->controller.filter.Tf, 0.2, 1e-12) << "a dead time within its standard error counts as none";
}

TEST(Robust, AnIdentifiedPlantWithLagsHasAFilterWhateverItsLeads) {
    const auto identified = [](const Plant& plant, double L_std) {
        return robust_method().tune(TuningProblem{plant, *LinearPlant::make(plant), L_std}, {}, {});
    };
    // Two lags, 1 and 2, and a lead that is shorter, almost as long, as long and longer than their sum; L = 2.4 cannot
    // be distinguished from 0.
    for (const auto& [lead, Tf] :
         {std::pair{1.5, 0.05 * 1.5}, {2.8, 0.05 * 0.2}, {3.0, 0.05 * 0.1}, {10.0, 0.05 * 0.1}}) {
        const auto tuned = identified(TransferFunction{{lead, 1}, {2, 3, 1}, 2.4}, 3);
        ASSERT_TRUE(tuned.has_value()) << lead << ": " << tuned.error().message;
        EXPECT_NEAR(tuned->controller.filter.Tf, Tf, 1e-9) << lead;
    }
    const auto without_lags = identified(Ipdt{.K = 1, .L = 2.4}, 3);
    ASSERT_FALSE(without_lags.has_value());
    EXPECT_EQ(without_lags.error().kind, ErrorKind::unbounded_optimum);
    EXPECT_NE(without_lags.error().message.find("identified dead time of 2.4"), std::string::npos)
        << without_lags.error().message;
}

TEST(Robust, StopsWithTheBestSoFar) {
    std::stop_source source;
    RunControl control;
    control.stop = source.get_token();
    int reports = 0;
    double fraction = 0;
    control.progress = [&](const Progress& progress) {
        EXPECT_GE(progress.fraction, fraction);
        fraction = progress.fraction;
        EXPECT_TRUE(progress.best);
        if (++reports == 2) source.request_stop();
    };
    const auto tuned =
        design(Sopdt{.K = 1, .T1 = 10, .T2 = 3, .L = 2}, with({{"search", std::string("grid")}}), control);
    ASSERT_TRUE(tuned.has_value());
    EXPECT_TRUE(tuned->partial);
    EXPECT_LE(*evaluated(Sopdt{.K = 1, .T1 = 10, .T2 = 3, .L = 2}, tuned->controller).robustness.Ms, 1.4 * (1 + 2e-5));
}

TEST(Robust, SurfaceHasItsLeastValueAtTheDesign) {
    const Plant plant = Fopdt{.K = 1, .T = 4, .L = 1};
    const auto tuned = design(plant, with({{"surface", true}, {"search", std::string("grid")}}));
    ASSERT_TRUE(tuned.has_value() && tuned->report_as<CostSurface>());
    const double IAE = *evaluated(plant, tuned->controller).performance.load.IAE;
    int feasible = 0;
    for (const auto& row : tuned->report_as<CostSurface>()->cost) {
        EXPECT_EQ(row.size(), tuned->report_as<CostSurface>()->Td.size());
        for (const auto& cost : row) {
            feasible += cost.has_value();
            EXPECT_GE(cost.value_or(IAE), IAE * (1 - 1e-3));
        }
    }
    EXPECT_GT(feasible, 50);
}

TEST(LocalMinimum, BothSearchesFindRosenbrocksValley) {
    const auto f = [](const std::vector<double>& x, bool&) {
        return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2);
    };
    for (const auto search : {LocalSearch::nelder_mead, LocalSearch::subplex}) {
        const auto minimum =
            find_local_minimum(search, f, {-1.2, 1}, {.step = {0.5, 0.5}, .tolerance = 1e-12, .max_evaluations = 4000});
        EXPECT_NEAR(minimum.x[0], 1, 1e-3);
        EXPECT_NEAR(minimum.x[1], 1, 1e-3);
    }
}

// Far above 1/T1 the plant is 1/(T1 s (T2 s + 1)): times scale with T2, the gain with T1/T2, the load IAE with T2^2/T1.
TEST(Robust, OnLagsFarApartAPiLivesAtTheFasterOne) {
    MethodOptions options;
    options.set("Ms", 2.5);
    options.set("Mt", 2.5);
    options.set("controller", std::string("PI"));
    for (const double T2 : {1e-4, 1e-6, 1e-9}) {
        const Plant plant = Sopdt{.K = 1, .T1 = 1, .T2 = T2, .L = 0};
        const auto tuned = robust_method().tune({plant, *LinearPlant::make(plant), {}, {}}, options, {});
        ASSERT_TRUE(tuned) << tuned.error().message;
        EXPECT_NEAR(tuned->controller.Kp * T2, 2.411, 0.01) << T2;
        EXPECT_NEAR(tuned->controller.Ti / T2, 3.828, 0.02) << T2;
    }
}

TEST(Sweep, GradientsAgreeWithDifferences) {
    using namespace robust;
    const auto plant = LinearPlant::make(Sopdt{.K = 1, .T1 = 2, .T2 = 1, .L = 0.5});
    for (const bool tied : {true, false})
        for (const bool circle : {true, false}) {
            DesignProblem problem;
            problem.plant = &*plant;
            problem.limits = {.Ms = 1.3, .Mt = 1.2, .Mks = 3, .m_circle = circle};
            problem.filter = tied ? FilterRule{std::nullopt, 0.2} : FilterRule{0.1, std::nullopt};
            const Sweep sweep(problem, reference_frequency(problem));
            const DesignPoint x = {std::log(2.0), std::log(2.5), std::log(0.6)};
            const auto peaks = sweep.peaks(x, -2);
            ASSERT_FALSE(peaks.empty());
            for (const auto& peak : peaks)
                for (std::size_t i = 0; i < 3; ++i) {
                    if (!std::isfinite(peak.omega)) continue;
                    DesignPoint up = x, down = x;
                    up[i] += 1e-5;
                    down[i] -= 1e-5;
                    const double slope =
                        (sweep.value(peak.kind, up, peak.omega) - sweep.value(peak.kind, down, peak.omega)) / 2e-5;
                    EXPECT_NEAR(peak.gradient[i], slope, 1e-6 * (1 + std::abs(slope)));
                }
        }
}

}  // namespace
}  // namespace tunewright
