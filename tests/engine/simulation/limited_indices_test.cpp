// Indices within actuator limits compared with a fixed-step program: the classical Runge-Kutta method with 800 steps
// per dead time, the delayed input stored at half steps, Simpson's rule; its own error, from 400 steps, is 2e-8 or
// less.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/evaluation/evaluate.h"

namespace tunewright {
namespace {

struct Case {
    Zpk plant;
    ParallelPid controller;
    bool setpoint = true;  // a unit step of the set point, or otherwise of the load
    ActuatorLimits limits;
    double horizon = 0;
    double IAE = 0, ISE = 0, ITAE = 0, TV = 0;
};

std::vector<Case> cases() {
    const Zpk lag{.K = 0.1, .zeros = {}, .poles = {-0.1}, .L = 3};
    const ParallelPid pi{.Kp = 2, .Ki = 0.25};
    const Zpk third_order{.K = 0.125, .zeros = {}, .poles = {-0.5, -0.5, -0.5}, .L = 1};
    const ParallelPid pid{.Kp = 0.9, .Ki = 0.18, .Kd = 0.9, .filter = {FilterType::derivative, 0.2}};
    const Zpk integrating{.K = 0.05, .zeros = {}, .poles = {0.0, -0.5}, .L = 2};
    const ParallelPid filtered{
        .Kp = 0.9, .Ki = 0.0225, .Kd = 2.7, .b = 0.5, .filter = {FilterType::measurement_second_order, 0.4}};
    const Zpk oscillating{.K = 1, .zeros = {}, .poles = {{-0.2, 0.9}, {-0.2, -0.9}}, .L = 0.7};
    const ParallelPid mostly_integral{.Kp = 0.3, .Ki = 0.25, .Kd = 0.15, .filter = {FilterType::derivative, 0.1}};
    return {
        {lag, pi, true, {-0.6, 1.25}, 120, 9.43198844, 6.52219857, 61.7408159, 1.58613429},
        {lag, pi, false, {-1.05, 0.2}, 120, 4.51168784, 1.11038176, 57.3901671, 1.10853172},
        {third_order, pid, true, {-0.27, 1.25}, 40, 6.28137928, 4.75634698, 24.8809325, 1.54581614},
        {third_order, pid, false, {-1.05, 0.2}, 40, 5.55156679, 2.14552072, 58.4623443, 1.03174417},
        {integrating, filtered, true, {-0.27, 0.3}, 80, 24.5770970, 15.9222698, 425.673796, 0.595087566},
        {integrating, filtered, false, {-1.05, 0.2}, 80, 54.1691139, 40.2640134, 2297.13967, 1.05},
        {oscillating, mostly_integral, true, {-0.09, 1}, 40 * 0.7, 5.07460720, 2.53889847, 37.4503249, 1.50483095},
        {oscillating, mostly_integral, false, {-1.05, 0.2}, 40 * 0.7, 8.76619858, 5.57124463, 83.4654013, 2.58334300},
    };
}

template <class Figures>
void hold(const Case& c, const Figures& figures, const IndexErrors& stated) {
    ASSERT_TRUE(figures.IAE && figures.ISE && figures.ITAE && figures.TV);
    EXPECT_NEAR(*figures.IAE / c.IAE, 1, 1e-6);
    EXPECT_NEAR(*figures.ISE / c.ISE, 1, 1e-6);
    EXPECT_NEAR(*figures.ITAE / c.ITAE, 1, 1e-6);
    EXPECT_NEAR(*figures.TV / c.TV, 1, 1e-6);
    ASSERT_TRUE(stated.IAE && stated.ISE && stated.ITAE && stated.TV);
}

TEST(LimitedIndices, AgreeWithAFixedStepProgram) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.IAE);
        EvaluateOptions options;
        options.points = 0;
        options.horizon = c.horizon;
        options.actuator = c.limits;
        const auto e = evaluate(Plant(c.plant), Controller(c.controller), options);
        ASSERT_TRUE(e);
        if (c.setpoint)
            hold(c, e->performance.setpoint, e->verification.setpoint_errors);
        else
            hold(c, e->performance.load, e->verification.load_errors);
        for (const auto& warning : e->warnings) EXPECT_EQ(warning.code, "actuator-limited");
    }
}

}  // namespace
}  // namespace tunewright
