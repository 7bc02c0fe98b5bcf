// Set-point weights and filters: limits on the overshoot hold over many plants, regulation is unchanged, optima by
// grids.
#include "engine/tuning/method/setpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "engine/evaluation/evaluate.h"
#include "engine/request/tune.h"
#include "engine/tuning/registry.h"
#include "tests/engine/plant/subject_of.h"
#include "tests/engine/tuning/reference_batch.h"

namespace tunewright {
namespace {

Evaluation judged(const Plant& plant, const IdealPid& pid) {
    EvaluateOptions figures;
    figures.points = 0;
    return *evaluate(PlantModel(plant), pid, figures);
}

IdealPid weighed(const Plant& plant, IdealPid pid, const SetpointOptions& options) {
    const auto warnings = choose_setpoint(*LinearPlant::make(plant), options, pid);
    EXPECT_TRUE(warnings.empty()) << warnings.front().detail;
    return pid;
}

TuningEntry weighted(const Plant& plant, const char* key, double value, const char* method = "robust") {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = {MethodRequest{.method = method, .options = {}}};
    if (key != nullptr) request.tune[0].options.set(std::string("setpoint/") + key, value);
    request.evaluate.points = 0;
    auto result = tune(request, {});
    if (result) return result->controllers.front();
    TuningEntry none;
    none.error = result.error();
    return none;
}

TEST(Setpoint, TheDefaultKeepsFivePercentOverTheAmigoBatchAndLeavesRegulationAlone) {
    for (const auto& row : test::reference_rows()) {
        SCOPED_TRACE(row.at("id").get<std::string>());
        const Plant plant = test::plant_of(row);
        const TuningEntry by_default = weighted(plant, nullptr, 0), one = weighted(plant, "weight", 1);
        ASSERT_EQ(by_default.error.has_value(), one.error.has_value());
        if (!by_default.evaluation) continue;
        const Evaluation &a = *by_default.evaluation, &b = *one.evaluation;
        EXPECT_LE(*a.performance.setpoint.overshoot_percent, 5);
        EXPECT_NEAR(*a.performance.load.IAE / *b.performance.load.IAE, 1, 1e-9);
        EXPECT_NEAR(*a.performance.load.peak / *b.performance.load.peak, 1, 1e-9);
        EXPECT_NEAR(*a.robustness.Ms / *b.robustness.Ms, 1, 1e-9);
        EXPECT_NEAR(*a.robustness.Mt / *b.robustness.Mt, 1, 1e-9);
    }
}

TEST(Setpoint, AnyOvershootIsKeptOnPlantsOfManyKinds) {
    std::mt19937 chance(7);
    const auto between = [&](double low, double high) {
        return low * std::pow(high / low, std::uniform_real_distribution<>()(chance));
    };
    int filtered = 0, full = 0;
    for (int i = 0; i < 60; ++i) {
        const double L = between(0.02, 5);
        Plant plant = Fopdt{.K = between(0.1, 10), .T = 1, .L = L};
        if (i % 4 == 1) plant = Ipdt{.K = between(0.1, 10), .L = L};
        if (i % 4 == 2) plant = Sopdt{.K = -between(0.1, 10), .T1 = 1, .T2 = between(0.1, 1), .L = L};
        if (i % 4 == 3) plant = Fopdt{.K = 1, .T = -1, .L = between(0.02, 0.2)};
        MethodOptions loose;
        loose.set("Ms", 2.2);
        loose.set("Mt", 2.2);
        const LinearPlant linear = *LinearPlant::make(plant);
        const auto design = find_method("robust")->tune({plant, linear, {}, {}}, loose, {});
        if (!design) continue;
        for (const double limit : {0.0, 2.0, 10.0, 20.0}) {
            const IdealPid pid = weighed(plant, design->controller, {.overshoot = limit});
            filtered += pid.setpoint_lag > 0;
            full += pid.b == 1;
            const double overshoot = *judged(plant, pid).performance.setpoint.overshoot_percent;
            EXPECT_LE(overshoot, std::max(limit, 5e-3)) << "plant " << i << " limit " << limit;
            if (pid.setpoint_lag > 0 || pid.b == 1) continue;
            // A slightly larger weight would exceed the limit or have no lower IAE.
            IdealPid more = pid;
            more.b = std::min(1.0, pid.b + 2e-3);
            const SetpointPerformance with_more = judged(plant, more).performance.setpoint;
            EXPECT_TRUE(*with_more.overshoot_percent > limit - 0.05 ||
                        *with_more.IAE >= *judged(plant, pid).performance.setpoint.IAE)
                << "plant " << i << " limit " << limit;
        }
    }
    EXPECT_GT(filtered, 3);
    EXPECT_GT(full, 0);
}

/// The shortest filter that keeps the limit with this weight, by bisection; evaluated by the engine's own figures.
double min_IAE_of_a_grid(const Plant& plant, IdealPid pid, double limit) {
    double min = std::numeric_limits<double>::infinity();
    const auto over = [&](double T) {
        pid.setpoint_lag = T;
        return *judged(plant, pid).performance.setpoint.overshoot_percent > limit;
    };
    for (const double b : {0.0, 0.25, 0.5, 0.75, 0.9, 1.0}) {
        pid.b = b;
        double low = 0, high = 1e-3;
        if (over(0)) {
            while (over(high)) low = high, high *= 2;
            for (int i = 0; i < 20; ++i) (over(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
        } else {
            high = 0;
        }
        pid.setpoint_lag = high;
        min = std::min(min, *judged(plant, pid).performance.setpoint.IAE);
    }
    return min;
}

// 2 e^(-3s)/(10 s + 1) at Ms 1.4: b = 0 needs T = 5.54 and has an IAE of 15.60; b = 1 with T = 8.01 has 12.29.
TEST(Setpoint, WeightAndFilterAreChosenTogether) {
    const Evaluation design = *weighted(Fopdt{.K = 2, .T = 10, .L = 3}, nullptr, 0).evaluation;
    const IdealPid& pid = std::get<IdealPid>(design.controller);
    EXPECT_EQ(pid.b, 1);
    EXPECT_NEAR(pid.setpoint_lag, 8.01, 0.01);
    EXPECT_NEAR(*design.performance.setpoint.IAE, 12.289, 2e-3);
    EXPECT_LE(*design.performance.setpoint.overshoot_percent, 5);
}

TEST(Setpoint, NoOtherPairHasALowerIae) {
    std::mt19937 chance(70);
    const auto between = [&](double low, double high) {
        return low * std::pow(high / low, std::uniform_real_distribution<>()(chance));
    };
    int filtered = 0;
    for (int i = 0; i < 24; ++i) {
        const double L = between(0.02, 5), M = between(1.2, 2.2);
        Plant plant = Fopdt{.K = between(0.1, 10), .T = 1, .L = L};
        if (i % 4 == 1) plant = Ipdt{.K = between(0.1, 10), .L = L};
        if (i % 4 == 2) plant = OscillatorySopdt{.K = -1, .T = 1, .zeta = between(0.1, 1), .L = L};
        if (i % 4 == 3) plant = Fopdt{.K = 1, .T = -1, .L = between(0.02, 0.2)};
        MethodOptions limits;
        for (const char* name : {"Ms", "Mt"}) limits.set(name, i % 4 == 3 ? 2.2 : M);
        const LinearPlant linear = *LinearPlant::make(plant);
        const auto design = find_method("robust")->tune({plant, linear, {}, {}}, limits, {});
        if (!design) continue;
        const double limit = i % 3 == 0 ? 2 : 5;
        const IdealPid pid = weighed(plant, design->controller, {.overshoot = limit});
        filtered += pid.setpoint_lag > 0;
        EXPECT_LE(*judged(plant, pid).performance.setpoint.IAE,
                  min_IAE_of_a_grid(plant, design->controller, limit) * (1 + 3e-3))
            << "plant " << i << ": b " << pid.b << ", T " << pid.setpoint_lag;
    }
    EXPECT_GT(filtered, 8);
}

TEST(Setpoint, WithoutAFilterTheWeightWithTheLeastOvershootIsTaken) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto design = find_method("robust")->tune({plant, *LinearPlant::make(plant), {}, {}}, {}, {});
    IdealPid pid = design->controller;
    const auto warnings = choose_setpoint(*LinearPlant::make(plant), {.overshoot = 5, .may_filter = false}, pid);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(pid.setpoint_lag, 0);
    const double min = *judged(plant, pid).performance.setpoint.overshoot_percent;
    for (const double b : {0.0, 0.05, 0.2, 0.5, 1.0}) {
        pid.b = b;
        EXPECT_GE(*judged(plant, pid).performance.setpoint.overshoot_percent, min - 1e-3) << b;
    }
}

// Along the limits the IAE is nearly continuous where the filter becomes necessary, although weight and filter are not.
// The shortest filter grows with the root of the overshoot that it removes, so 1e-5 of a limit still changes the IAE by
// some percent.
TEST(Setpoint, TheIaeIsContinuousWhereTheFilterComesIn) {
    for (const double L : {1.0, 3.0, 10.0}) {
        const Plant plant = Fopdt{.K = 2, .T = 10, .L = L};
        const LinearPlant linear = *LinearPlant::make(plant);
        const auto at = [&](double M) {
            MethodOptions limits;
            for (const char* name : {"Ms", "Mt"}) limits.set(name, M);
            IdealPid pid = find_method("robust")->tune({plant, linear, {}, {}}, limits, {})->controller;
            choose_setpoint(linear, {.overshoot = 5}, pid);
            return pid;
        };
        int seen = 0;
        for (const auto& [from, to] : {std::pair{1.12, 1.4}, std::pair{1.4, 2.5}}) {
            double without = from, with = to;
            if (at(without).setpoint_lag > 0) std::swap(without, with);
            if (at(without).setpoint_lag > 0 || at(with).setpoint_lag == 0) continue;
            ++seen;
            while (std::abs(with - without) > 1e-5)
                (at(0.5 * (with + without)).setpoint_lag > 0 ? with : without) = 0.5 * (with + without);
            EXPECT_NEAR(*judged(plant, at(with)).performance.setpoint.IAE /
                            *judged(plant, at(without)).performance.setpoint.IAE,
                        1, 0.08)
                << "L " << L << ", M " << with;
        }
        EXPECT_GT(seen, 0);
    }
}

TEST(Setpoint, TheBestWeightHasTheLeastIaeOfAGrid) {
    for (const Plant& plant : {Plant(Fopdt{.K = 2, .T = 10, .L = 3}), Plant(Ipdt{.K = 1, .L = 1}),
                               Plant(TransferFunction{.num = {-1, 1}, .den = {1, 3, 3, 1}, .L = 0})}) {
        const auto design = find_method("robust")->tune({plant, *LinearPlant::make(plant), {}, {}}, {}, {});
        IdealPid pid = weighed(plant, design->controller, {.best_IAE = true});
        const double found = *judged(plant, pid).performance.setpoint.IAE;
        for (int i = 0; i <= 100; ++i) {
            pid.b = i / 100.0;
            EXPECT_LE(found, *judged(plant, pid).performance.setpoint.IAE * (1 + 2e-5)) << "b " << pid.b;
        }
    }
}

// Only the filter, compared with the exact answer: y of a first-order loop 1/(s + 1) behind 1/(T s + 1).
TEST(Setpoint, AFilteredSetPointGivesTheLaggedResponse) {
    const IdealPid pid{.Kp = 1, .Ti = 1, .b = 1, .setpoint_lag = 0.5};  // 1/s + 1 = (s + 1)/s on 1/(s + 1)
    EvaluateOptions options;
    options.horizon = 6;
    options.points = 61;
    const auto answer = evaluate(PlantModel(Plant(TransferFunction{.num = {1}, .den = {1, 1}, .L = 0})), pid, options);
    ASSERT_TRUE(answer);
    const Trace& trace = answer->responses->setpoint;
    for (std::size_t i = 0; i < trace.t.size(); ++i) {
        const double t = trace.t[i];
        EXPECT_NEAR(trace.y[i], 1 - 2 * std::exp(-t) + std::exp(-2 * t), 1e-6) << t;
    }
    const IdealPid to_infinity = pid;
    const Evaluation whole = judged(Plant(TransferFunction{.num = {1}, .den = {1, 1}, .L = 0}), to_infinity);
    EXPECT_NEAR(*whole.performance.setpoint.IAE, 1.5, 1e-5);
    EXPECT_EQ(*whole.performance.setpoint.overshoot_percent, 0);
}

TEST(Setpoint, OnEquationsTheFilterDoesWhatItDoesOnTheirLinearTwin) {
    NonlinearPlant tank;
    tank.states = {{"x", 0}};
    tank.equations = {{"x", "-x + u"}};
    tank.output = "x";
    tank.input.name = "u";
    const AnalysedPlant subject = test::subject_of(tank);
    EvaluateOptions options;
    options.points = 0;
    for (const Filter& filter :
         {Filter{}, Filter{FilterType::derivative, 0.1}, Filter{FilterType::measurement_second_order, 0.1}}) {
        const IdealPid pid{.Kp = 2, .Ti = 0.8, .Td = 0, .b = 0.3, .filter = filter, .setpoint_lag = 0.7};
        const auto nonlinear = evaluate(subject, pid, options);
        ASSERT_TRUE(nonlinear) << nonlinear.error().message;
        const auto linear =
            evaluate(PlantModel(Plant(TransferFunction{.num = {1}, .den = {1, 1}, .L = 0})), pid, options);
        EXPECT_NEAR(*nonlinear->performance.setpoint.IAE / *linear->performance.setpoint.IAE, 1, 1e-4);
        EXPECT_NEAR(*nonlinear->performance.setpoint.overshoot_percent, *linear->performance.setpoint.overshoot_percent,
                    0.01);
    }
}

TEST(Setpoint, RulesKeepTheirSourcesWeightUnlessAsked) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto b_of = [](const TuningEntry& entry) { return std::get<IdealPid>(entry.evaluation->controller).b; };
    EXPECT_EQ(b_of(weighted(plant, nullptr, 0, "simc")), 1);
    EXPECT_EQ(b_of(weighted(plant, "weight", 0.25, "simc")), 0.25);
    const TuningEntry kept = weighted(plant, "overshoot", 1, "ziegler_nichols_step");
    EXPECT_LE(*kept.evaluation->performance.setpoint.overshoot_percent, 1);
}

TEST(Setpoint, WithoutIntegralActionItIsLeftAndSaidSo) {
    IdealPid pid{.Kp = 1};
    const auto warnings =
        choose_setpoint(*LinearPlant::make(Plant(Fopdt{.K = 2, .T = 10, .L = 3})), {.overshoot = 5}, pid);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings.front().code, "setpoint-left");
    EXPECT_EQ(pid.b, 1);
}

}  // namespace
}  // namespace tunewright
