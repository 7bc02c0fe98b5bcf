#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

Expected<Evaluation> evaluate(const NonlinearSystem& system, const Controller& controller,
                              const EvaluateOptions& options) {
    return evaluate_nonlinear({system, *linearised_plant(system)}, controller, options);
}

const Warning* warning(const Evaluation& evaluation, const std::string& code) {
    for (const auto& w : evaluation.warnings)
        if (w.code == code) return &w;
    return nullptr;
}

void expect_near(const std::optional<double>& a, const std::optional<double>& b, double relative, const char* what) {
    ASSERT_EQ(a.has_value(), b.has_value()) << what;
    if (a) {
        EXPECT_NEAR(*a, *b, relative * std::max(0.05, std::abs(*b))) << what;
    }
}

/// The linear evaluation's own interpolation.
constexpr double kLinear = 3e-4;

void expect_same(const Performance& a, const Performance& b) {
    expect_near(a.setpoint.IAE, b.setpoint.IAE, kLinear, "IAE");
    expect_near(a.setpoint.ISE, b.setpoint.ISE, kLinear, "ISE");
    expect_near(a.setpoint.ITAE, b.setpoint.ITAE, kLinear, "ITAE");
    expect_near(a.setpoint.overshoot_percent, b.setpoint.overshoot_percent, kLinear, "overshoot");
    expect_near(a.setpoint.rise_time, b.setpoint.rise_time, kLinear, "rise time");
    expect_near(a.setpoint.settling_time, b.setpoint.settling_time, kLinear, "settling time");
    expect_near(a.setpoint.TV, b.setpoint.TV, kLinear, "TV");
    expect_near(a.setpoint.first_move, b.setpoint.first_move, kLinear, "first move");
    expect_near(a.load.IAE, b.load.IAE, kLinear, "load IAE");
    expect_near(a.load.ITAE, b.load.ITAE, kLinear, "load ITAE");
    expect_near(a.load.peak, b.load.peak, kLinear, "peak");
    expect_near(a.load.recovery_time, b.load.recovery_time, kLinear, "recovery time");
    expect_near(a.load.TV, b.load.TV, kLinear, "load TV");
}

std::vector<Controller> controllers() {
    return {IdealPid{.Kp = 1.5, .Ti = 2.2},
            IdealPid{.Kp = 2, .Ti = 2.5, .Td = 0.6, .b = 0.5, .filter = {FilterType::derivative, 0.1}},
            IdealPid{.Kp = 2, .Ti = 2.5, .Td = 0.6, .filter = {FilterType::measurement_second_order, 0.2}},
            ParallelPid{.Ki = 0.2}, Npid{.Kp = 1.5, .Ti = 2.2, .Td = 0.4, .filter = {FilterType::derivative, 0.04}}};
}

TEST(EvaluateNonlinear, AgreesWithTheLinearEvaluationOnALinearPlant) {
    for (const double L : {0.0, 0.4}) {
        const Zpk plant{.K = 2, .zeros = {}, .poles = {-1.0, -2.0}, .L = L};
        const auto system = *as_equations(*LinearPlant::make(plant));
        for (const Controller& controller : controllers()) {
            SCOPED_TRACE(controller.index());
            const auto own = evaluate(system, controller, {});
            const auto linear = evaluate(PlantModel(Plant(plant)), controller, {});
            ASSERT_TRUE(own && linear);
            expect_same(own->performance, linear->performance);
            ASSERT_TRUE(own->linear);
            expect_same(own->linear->performance, linear->performance);
            EXPECT_FALSE(warning(*own, "far-from-linear"));
            EXPECT_NEAR(*own->robustness.Ms, *linear->robustness.Ms, 1e-6);
            ASSERT_TRUE(own->responses && own->linear->responses);
            EXPECT_EQ(own->responses->setpoint.t, own->linear->responses->setpoint.t);
        }
    }
}

TEST(EvaluateNonlinear, HoldsToAGivenHorizon) {
    EvaluateOptions options;
    options.setpoint_step = -10;
    options.horizon = 10;
    const auto evaluation = evaluate(made_system(cstr("T")), IdealPid{.Kp = 1.81, .Ti = 0.403}, options);
    ASSERT_TRUE(evaluation);
    const auto& setpoint = evaluation->performance.setpoint;
    EXPECT_NEAR(*setpoint.IAE, 10.053186752, 1e-5);
    EXPECT_NEAR(*setpoint.overshoot_percent, 0.09857507, 1e-4);
    EXPECT_NEAR(*setpoint.settling_time, 3.7083888, 1e-4);
    EXPECT_EQ(evaluation->responses->setpoint.t.back(), 10);
}

TEST(EvaluateNonlinear, TellsWhereTheStatesLeaveTheModel) {
    EvaluateOptions options;
    options.setpoint_step = 0.14;
    options.load_step = 1;
    const IdealPid kick{.Kp = -11753, .Ti = 0.2, .Td = 0.05, .c = 1, .filter = {FilterType::derivative, 0.1}};
    const auto evaluation = evaluate(made_system(cstr("CA")), kick, options);
    ASSERT_TRUE(evaluation);
    EXPECT_TRUE(evaluation->robustness.stable);
    ASSERT_TRUE(warning(*evaluation, "left-domain"));
    EXPECT_NE(warning(*evaluation, "left-domain")->detail.find("After the set-point step: At t = "), std::string::npos);
    const auto& setpoint = evaluation->performance.setpoint;
    EXPECT_FALSE(setpoint.IAE);
    EXPECT_NE(setpoint.IAE.why.find("ended early"), std::string::npos);
    EXPECT_TRUE(evaluation->performance.load.IAE);
    ASSERT_TRUE(evaluation->linear);
    EXPECT_TRUE(evaluation->linear->performance.setpoint.IAE);
    ASSERT_TRUE(evaluation->responses);
    EXPECT_LT(evaluation->responses->setpoint.t.back(), 1);
    for (const double y : evaluation->responses->setpoint.y) EXPECT_TRUE(std::isfinite(y));
}

TEST(EvaluateNonlinear, SaysHowFarTheResponsesAreFromTheLinearOnes) {
    const auto system = made_system(cstr("CA"));
    const IdealPid controller{.Kp = -11753, .Ti = 0.2, .Td = 0.05, .filter = {FilterType::derivative, 0.1}};
    EvaluateOptions options;
    options.setpoint_step = 0.05;
    const auto far = evaluate(system, controller, options);
    ASSERT_TRUE(far && warning(*far, "far-from-linear"));
    EXPECT_NE(warning(*far, "far-from-linear")->detail.find("overshoot 61.73 % against"), std::string::npos)
        << warning(*far, "far-from-linear")->detail;
    options.setpoint_step = 1e-4;
    options.load_step = 0.01;
    const auto near = evaluate(system, controller, options);
    ASSERT_TRUE(near);
    EXPECT_FALSE(warning(*near, "far-from-linear"));
    expect_near(near->performance.load.IAE, near->linear->performance.load.IAE, 1e-2, "load IAE");
}

TEST(EvaluateNonlinear, KeepsWithinThePlantsLimitsAndTheActuators) {
    NonlinearPlant plant = cstr("T");
    plant.input.max = 493.87 + 50;
    EvaluateOptions options;
    options.setpoint_step = 10;
    const IdealPid controller{.Kp = 15, .Ti = 0.1667};
    const auto by_plant = evaluate(made_system(plant), controller, options);
    ASSERT_TRUE(by_plant && warning(*by_plant, "actuator-limited"));
    for (const auto* responses : {&*by_plant->responses, &*by_plant->linear->responses})
        EXPECT_NEAR(*std::ranges::max_element(responses->setpoint.u), 50, 1e-6);
    EXPECT_EQ(*by_plant->performance.setpoint.first_move, 50);
    EXPECT_EQ(*by_plant->linear->performance.setpoint.first_move, 50);
    options.actuator = ActuatorLimits{-20, 47};
    const auto by_both = evaluate(made_system(plant), controller, options);
    EXPECT_EQ(*by_both->performance.setpoint.first_move, 47);
}

TEST(EvaluateNonlinear, ShowsWhatAnUnstableLoopDoes) {
    EvaluateOptions options;
    options.actuator = ActuatorLimits{-20, 20};
    const auto evaluation = evaluate(made_system(cstr("T")), IdealPid{.Kp = -10, .Ti = 1}, options);
    ASSERT_TRUE(evaluation);
    EXPECT_FALSE(evaluation->robustness.stable);
    EXPECT_TRUE(warning(*evaluation, "unstable-loop"));
    EXPECT_FALSE(evaluation->performance.setpoint.IAE);
    ASSERT_TRUE(evaluation->responses);
    EXPECT_NEAR(std::abs(evaluation->responses->setpoint.u.back()), 20, 1e-6);
}

TEST(EvaluateNonlinear, RefusesWhatEveryEvaluationRefuses) {
    EvaluateOptions options;
    options.setpoint_step = 0;
    const auto refused = evaluate(made_system(cstr("T")), IdealPid{.Kp = 1}, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "evaluate/setpoint_step");
}

}  // namespace
}  // namespace tunewright
