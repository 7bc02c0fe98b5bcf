// A predictor's program against the same law with whole histories, and its refusals.
#include "engine/structure/program/predictor_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/code/interpreter.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

constexpr double kPeriod = 0.5;

/// The response at `t` of a first-order part K/(T s + 1), or K/s, to an input that is v[i] from i Ts on.
double response_to(const std::vector<double>& v, double t, double K, double T, bool integrating) {
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double begin = static_cast<double>(i) * kPeriod, step = v[i] - (i > 0 ? v[i - 1] : 0);
        if (t > begin) sum += step * (integrating ? K * (t - begin) : K * (1 - std::exp(-(t - begin) / T)));
    }
    return sum;
}

struct PredictorCase {
    PredictorModel model;
    PredictorKind kind;
};

TEST(PredictorProgram, ItIsTheLawWithWholeHistories) {
    // u = C [r - Gm u - F (y - Gm e^(-Lm s) u)] in which each response is the sum of its steps: the model's own, which
    // grows on an integrator, without the form that keeps a program's states small. F is (beta s + 1)/(Tf s + 1) or 1.
    for (const PredictorCase& c : {PredictorCase{{.K = 2, .T = 5, .L = 3.3}, PredictorKind::smith},
                                   {{.K = 2, .T = 5, .L = 3.3}, PredictorKind::filtered_smith},
                                   {{.K = 0.2, .L = 3.3, .integrating = true}, PredictorKind::filtered_smith},
                                   {{.K = 2, .T = -15, .L = 1.7}, PredictorKind::filtered_smith}}) {
        const PredictorModel& m = c.model;
        const LinearPlant plant = m.integrating ? transfer({m.K}, {1, 0}, m.L) : first_order(m.K, m.T, m.L);
        const auto design = design_predictor(m, plant, {.kind = c.kind, .Ms = 1.9}, {});
        ASSERT_TRUE(design) << design.error().message;
        const PredictorController& controller = design->controller;
        const auto program = usual_program(controller, kPeriod, {.u_min = 12, .u_max = 31, .bias = 20, .y0 = 30});
        ASSERT_TRUE(program) << program.error().message;
        code::Interpreter machine(*program);
        const auto pid = predictor_pid(controller);
        ASSERT_TRUE(pid);
        const double Ti = pid->Kp / pid->Ki;
        const bool filtered = controller.F.num.size() == 2;
        const double lead = filtered ? controller.F.num[0] / controller.F.num[1] : 0,
                     lag = filtered ? controller.F.den[0] / controller.F.den[1] : 0;
        std::vector<double> moved, measured;
        double integral = 0;
        const int calls = m.T < 0 ? 60 : 400;  // the plain form of an unstable model loses its digits
        for (int k = 0; k < calls; ++k) {
            const double t = k * kPeriod, r = k < 100 ? 31 : 27,
                         y = 30 + 1.5 * std::sin(0.11 * t) + 0.2 * std::cos(2 * t);
            const bool manual = k / 50 % 3 == 1;
            measured.push_back(0);
            const double y_base = 30.2;  // the first y
            const auto F_of =
                [&](const std::vector<double>& x) {  // at t, of a signal that is held and has its last value now
                    double behind = 0;
                    for (std::size_t i = 0; i + 1 < x.size(); ++i)
                        behind += (x[i] - (i > 0 ? x[i - 1] : 0)) *
                                  (1 - std::exp(-(t - static_cast<double>(i) * kPeriod) / lag));
                    return filtered ? behind + lead / lag * (x.back() - behind) : x.back();
                };
            // F sees y held; the model behind the dead time is exact where it cannot be held, on integrating and
            // unstable models.
            const double late = response_to(moved, t - m.L, m.K, m.T, m.integrating);
            const bool stable = !m.integrating && m.T > 0;
            measured.back() = y - y_base - (stable ? late : 0);
            double prediction = y_base + response_to(moved, t, m.K, m.T, m.integrating) + F_of(measured);
            if (!stable) {
                // F Gm e^(-Lm s) u exactly: partial fractions of (lead s + 1)/(lag s + 1) times the model.
                const double behind = response_to(moved, t - m.L, m.K, lag, false);
                prediction -= m.integrating ? late + (lead - lag) * behind
                                            : ((lead - m.T) * late + (lag - lead) * behind) / (lag - m.T);
            }
            machine["setpoint"] = r;
            machine["measurement"] = y;
            machine["manual"] = manual;
            machine["manual_output"] = 22;
            machine.call();
            double u = 20;
            const double P = pid->Kp * (r - prediction);
            if (manual || k == 0) {
                u = manual ? 22 : 20;
                integral = u - P;
            } else {
                integral += P / Ti * kPeriod;
                u = std::clamp(P + integral, 12.0, 31.0);
                integral += std::min(1.0, kPeriod / std::abs(Ti)) * (u - P - integral);
            }
            ASSERT_NEAR(machine["u"], u, 1e-7) << "call " << k << " T " << m.T << " kind " << int(c.kind);
            moved.push_back(u - 20);
        }
    }
}

TEST(PredictorProgram, WhatCannotBeWrittenIsRefused) {
    PredictorController controller;
    controller.model = {.K = 2, .T = -15, .L = 1.7};
    controller.C = {{1, 1}, {1, 0}};
    controller.F = {{1}, {1}};
    EXPECT_EQ(usual_program(controller, kPeriod, {}).error().where, "controller/F");  // F must cancel the pole
    controller.model = {.K = 2, .T = 15, .L = 1.7};
    EXPECT_TRUE(usual_program(controller, kPeriod, {}));
    controller.C = {{1, 1}, {1, 2, 1, 0}};
    EXPECT_EQ(usual_program(controller, kPeriod, {}).error().where, "controller/C");
    controller.C = {{1, 1}, {1, 0}};
    EXPECT_EQ(usual_program(controller, 1e-5, {}).error().where, "sample_time");
}

TEST(PredictorProgram, AFractionIsReadAsAPid) {
    // Kp + Ki/s + Kd s/(Tf s + 1) with 2, 0.5, 3, 0.4.
    PredictorController controller;
    controller.C = {{0.8 + 3, 2 + 0.2, 0.5}, {0.4, 1, 0}};
    const auto pid = predictor_pid(controller);
    ASSERT_TRUE(pid);
    EXPECT_NEAR(pid->Kp, 2, 1e-12);
    EXPECT_NEAR(pid->Ki, 0.5, 1e-12);
    EXPECT_NEAR(pid->Kd, 3, 1e-12);
    EXPECT_NEAR(pid->filter.Tf, 0.4, 1e-12);
    controller.C = {{3}, {2, 0}};
    EXPECT_EQ(predictor_pid(controller)->Kp, 0);
    EXPECT_EQ(predictor_pid(controller)->Ki, 1.5);
    controller.C = {{2}, {4}};
    EXPECT_EQ(predictor_pid(controller)->Kp, 0.5);
}

}  // namespace
}  // namespace tunewright::structure
