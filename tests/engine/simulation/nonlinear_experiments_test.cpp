#include "engine/simulation/experiment/nonlinear_experiments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/identification/identify.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "engine/simulation/linear/step_response.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

NonlinearSystem as_system(const Plant& plant) { return *as_equations(*LinearPlant::make(plant)); }

RelaySettings settings(double amplitude, double hysteresis) {
    RelaySettings settings;
    settings.u_plus = amplitude;
    settings.u_minus = -amplitude;
    settings.hysteresis = hysteresis;
    return settings;
}

IdentifiedModel identified(const StepTest& test, ModelChoice model) {
    Record record{.t = test.t, .u = test.u, .y = test.y, .kind = RecordKind::step, .u0 = 0, .y0 = 0, .line = {}};
    return *identify(record, {.model = model, .method = {}, .shift = {}}, {});
}

TEST(NonlinearStepTest, OfALinearPlantIsItsStepResponse) {
    for (const Plant& plant : {Plant(Fopdt{.K = 2, .T = 3, .L = 1}), Plant(Sopdt{.K = -1, .T1 = 4, .T2 = 1, .L = 0}),
                               Plant(OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.3, .L = 0.2})}) {
        const auto test = simulate_step_test(as_system(plant), 0.5, {});
        ASSERT_TRUE(test);
        EXPECT_TRUE(test->settled);
        EXPECT_EQ(test->du, 0.5);
        ASSERT_GE(test->t.size(), 300u);
        ASSERT_LE(test->t.size(), 2000u);
        const LinearPlant linear = *LinearPlant::make(plant);
        EXPECT_NEAR(test->y.back(), 0.5 * linear.low_frequency_gain(), 2e-4);
        const auto samples = step_response(linear);
        const auto exact = [&](double t) {
            t -= linear.dead_time();
            if (t < 0) return 0.0;
            auto from = samples.begin();
            while (from + 1 != samples.end() && (from + 1)->t <= t) ++from;
            return step_response_after(linear.realisation(), *from, t - from->t).y;
        };
        for (std::size_t i = 0; i < test->t.size(); ++i) {
            ASSERT_EQ(test->u[i], test->t[i] < 0 ? 0 : 0.5);
            ASSERT_NEAR(test->y[i], 0.5 * exact(test->t[i]), 1e-8) << test->t[i];
        }
    }
}

TEST(NonlinearStepTest, IsReadByIdentificationLikeAMeasuredOne) {
    const auto test = simulate_step_test(as_system(Fopdt{.K = 2, .T = 3, .L = 1}), -1, {});
    const auto model = identified(*test, ModelChoice::fopdt);
    const auto& fopdt = std::get<Fopdt>(model.plant);
    EXPECT_NEAR(fopdt.K, 2, 2e-3);
    EXPECT_NEAR(fopdt.T, 3, 3e-3);
    EXPECT_NEAR(fopdt.L, 1, 1e-3);
}

// Step tests of the reference: least squares over 0 to 15 min.
TEST(NonlinearStepTest, OfTheStirredTankGivesTheReferencesModels) {
    const auto system = made_system(cstr("CA"));
    struct Row {
        double du, K, T, L;
    };
    for (const Row& row : {Row{5, -0.00278101347653477, 0.899373602064499, 0.11265848269172248},
                           Row{10, -0.00277799768666804, 0.8951247049250374, 0.11167018990362335},
                           Row{15, -0.002774327898044656, 0.8904348850765745, 0.11101257659035174}}) {
        const auto test = simulate_step_test(system, row.du, {});
        ASSERT_TRUE(test && test->settled);
        const auto model = identified(*test, ModelChoice::fopdt);
        const auto& fopdt = std::get<Fopdt>(model.plant);
        EXPECT_NEAR(fopdt.K, row.K, 2e-3 * std::abs(row.K));
        EXPECT_NEAR(fopdt.T, row.T, 1e-2 * row.T);
        EXPECT_NEAR(fopdt.L, row.L, 2e-2 * row.L);
    }
}

TEST(NonlinearStepTest, OfPlantsThatDoNotSettleMovesEnoughToSeeThem) {
    const auto ramp = simulate_step_test(as_system(Ipdt{.K = 0.5, .L = 2}), 1, {});
    ASSERT_TRUE(ramp);
    EXPECT_FALSE(ramp->settled);
    const auto integrating = identified(*ramp, ModelChoice::ipdt);
    EXPECT_NEAR(std::get<Ipdt>(integrating.plant).K, 0.5, 1e-3);
    EXPECT_NEAR(std::get<Ipdt>(integrating.plant).L, 2, 1e-2);
    const auto growing = simulate_step_test(as_system(Fopdt{.K = 1, .T = -3, .L = 0.5}), 1, {});
    ASSERT_TRUE(growing);
    EXPECT_FALSE(growing->settled);
    EXPECT_GT(std::abs(growing->y.back()), 10);
}

TEST(NonlinearStepTest, SaysWhyThereIsNone) {
    NonlinearPlant at_limit = cstr("T");
    at_limit.input.max = at_limit.input.nominal;
    const auto no_room = simulate_step_test(made_system(at_limit), 5, {});
    ASSERT_FALSE(no_room);
    EXPECT_EQ(no_room.error().kind, ErrorKind::unsupported);
    EXPECT_NE(no_room.error().message.find("is at its limit on that side"), std::string::npos);
    at_limit.input.max = at_limit.input.nominal + 3;
    EXPECT_EQ(simulate_step_test(made_system(at_limit), 5, {})->du, 3);

    // x' = u - sqrt(x): with u < 0 the tank runs empty.
    const auto empties = simulate_step_test(made_system(scalar_plant("u-sqrt(x)-0.1", 1, 1.1)), -1.2, {});
    ASSERT_FALSE(empties);
    EXPECT_EQ(empties.error().kind, ErrorKind::unsupported);
    EXPECT_NE(empties.error().message.find("leave the model's domain"), std::string::npos);

    std::stop_source source;
    source.request_stop();
    const auto stopped = simulate_step_test(made_system(cstr("T")), 5, {source.get_token(), {}, {}});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::cancelled);
}

TEST(NonlinearRelayTest, OfALinearPlantHasItsLimitCycle) {
    struct Case {
        Plant plant;
        double amplitude, hysteresis;
    };
    for (const Case& c : {Case{Fopdt{.K = 2, .T = 3, .L = 1}, 1, 0.1}, Case{Fopdt{.K = -2, .T = 3, .L = 1}, 1, 0.1},
                          Case{Zpk{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0}, .L = 0}, 1, 0.05},
                          Case{Ipdt{.K = 0.5, .L = 1}, 2, 0.1}, Case{Sopdt{.K = 1, .T1 = 2, .T2 = 1, .L = 0}, 1, 0.1},
                          Case{Fopdt{.K = 1, .T = -3, .L = 0.5}, 1, 0.0}}) {
        const auto test = simulate_relay_test(as_system(c.plant), c.amplitude, c.hysteresis, {});
        ASSERT_TRUE(test) << test.error().message;
        const auto exact = simulate_relay(c.plant, settings(c.amplitude, c.hysteresis), {});
        ASSERT_TRUE(exact);
        EXPECT_NEAR(test->Pu, exact->limit_cycle.Pu, 1e-5 * test->Pu);
        const double a = 0.5 * (*exact->limit_cycle.y_max - *exact->limit_cycle.y_min);
        EXPECT_NEAR(test->Ku, 4 * c.amplitude / (std::numbers::pi * std::sqrt(a * a - c.hysteresis * c.hysteresis)),
                    1e-4 * test->Ku);
        EXPECT_EQ(test->reversed, exact->reversed);
        ASSERT_GE(test->record.t.size(), 300u);
        EXPECT_LE(test->record.t.size(), 2000u);
        for (std::size_t i = 1; i < test->record.t.size(); ++i) ASSERT_GT(test->record.t[i], test->record.t[i - 1]);
        EXPECT_EQ(test->record.u.front(), c.amplitude);
    }
}

TEST(NonlinearRelayTest, OfSmallAmplitudeNearsTheLinearUltimatePoint) {
    NonlinearPlant plant = cstr("T");
    plant.L = 0.05;
    const auto system = made_system(plant);
    const auto test = simulate_relay_test(system, 0.5, 0, {});
    ASSERT_TRUE(test);
    const auto linear = simulate_relay(system.linearised(), settings(0.5, 0), {});
    ASSERT_TRUE(linear);
    EXPECT_NEAR(test->Pu, linear->limit_cycle.Pu, 1e-3 * test->Pu);
    EXPECT_NEAR(test->Ku, linear->limit_cycle.describing_function->Ku, 2e-3 * test->Ku);
    EXPECT_FALSE(test->reversed);
}

TEST(NonlinearRelayTest, IsReadByIdentificationLikeAMeasuredOne) {
    const auto test = simulate_relay_test(as_system(Fopdt{.K = 2, .T = 3, .L = 1}), 1, 0.1, {});
    Record record{.t = test->record.t,
                  .u = test->record.u,
                  .y = test->record.y,
                  .kind = RecordKind::relay,
                  .u0 = 0,
                  .y0 = 0,
                  .line = {}};
    const auto model = identify(record, {.model = ModelChoice::fopdt, .method = {}, .shift = {}}, {});
    ASSERT_TRUE(model);
    const auto& fopdt = std::get<Fopdt>(model->plant);
    EXPECT_NEAR(fopdt.K, 2, 0.02);
    EXPECT_NEAR(fopdt.T, 3, 0.03);
    EXPECT_NEAR(fopdt.L, 1, 0.01);
}

TEST(NonlinearRelayTest, TurnsRoundForANegativeGain) {
    NonlinearPlant plant = cstr("CA");
    plant.L = 0.05;
    const auto test = simulate_relay_test(made_system(plant), 5, 0, {});
    ASSERT_TRUE(test);
    EXPECT_TRUE(test->reversed);
    EXPECT_GT(test->Ku, 0);
}

TEST(NonlinearRelayTest, SaysWhyThereIsNone) {
    const auto message = [](const Expected<NonlinearRelayTest>& test) {
        return test ? std::string("none") : test.error().message;
    };
    const auto tank = made_system(cstr("T"));
    EXPECT_NE(message(simulate_relay_test(tank, 5, 0, {})).find("Give it a hysteresis"), std::string::npos);
    EXPECT_NE(message(simulate_relay_test(tank, 5, 3, {})).find("Lower the hysteresis below"), std::string::npos)
        << message(simulate_relay_test(tank, 5, 3, {}));
    EXPECT_NE(message(simulate_relay_test(tank, 5, 0.1, {})).find("shows no ultimate gain"), std::string::npos);
    NonlinearPlant one_sided = cstr("T");
    one_sided.input.min = one_sided.input.nominal;
    EXPECT_NE(message(simulate_relay_test(made_system(one_sided), 5, 0.1, {})).find("is at a limit"),
              std::string::npos);
    const auto empties = simulate_relay_test(made_system(scalar_plant("u-sqrt(x)-0.1", 1, 1.1)), 1.2, 1.5, {});
    EXPECT_NE(message(empties).find("leave the model's domain"), std::string::npos) << message(empties);
    std::stop_source source;
    source.request_stop();
    EXPECT_EQ(simulate_relay_test(tank, 5, 0.1, {source.get_token(), {}, {}}).error().kind, ErrorKind::cancelled);
}

}  // namespace
}  // namespace tunewright
