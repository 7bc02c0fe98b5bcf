// The rules on the ultimate point: plants with closed-form Ku and Pu, the source of the point, and refusals.
#include <numbers>

#include "engine/tuning/registry.h"
#include "tests/engine/tuning/rule_support.h"

namespace tunewright {
namespace {

using test::expect_settings;
using test::Given;
using test::kP;
using test::kPI;
using test::tuned;
using test::warns;
using test::word;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;
const double infinity = std::numeric_limits<double>::infinity();

struct Known {
    const char* name;
    Plant plant;
    double Ku, Pu;
};

// Ku and Pu by hand: the frequency at which the phase is -180 degrees, and the gain there.
const std::vector<Known> kKnown{
    {"pure dead time", Fopdt{.K = 4, .T = 0, .L = 3}, 0.25, 6},
    {"integrator with dead time", Ipdt{.K = 0.5, .L = 2}, pi / 2, 8},
    {"integrator of negative slope", Ipdt{.K = -0.5, .L = 2}, -pi / 2, 8},
    {"three lags of 1", Zpk{.K = 1, .zeros = {}, .poles = {-1.0, -1.0, -1.0}}, 8, 2 * pi / std::sqrt(3.0)},
    {"four lags of 1", Zpk{.K = 2, .zeros = {}, .poles = {-1.0, -1.0, -1.0, -1.0}}, 2, 2 * pi},
    {"integrator and two lags of 1", Zpk{.K = 1, .zeros = {}, .poles = {0.0, -1.0, -1.0}}, 2, 2 * pi},
    // omega L + atan(omega T) = pi at omega = 1 for T = 1, L = 3 pi/4.
    {"lag and dead time", Fopdt{.K = 1, .T = 1, .L = 0.75 * pi}, std::sqrt(2.0), 2 * pi},
};

TEST(ZieglerNicholsUltimate, TakesItsSharesOfTheExactUltimatePoint) {
    for (const auto& [name, plant, Ku, Pu] : kKnown) {
        SCOPED_TRACE(name);
        const double tolerance = 1e-6;
        expect_settings(tuned("ziegler_nichols_ultimate", plant, kP), 0.5 * Ku, infinity, 0, tolerance);
        expect_settings(tuned("ziegler_nichols_ultimate", plant, kPI), 0.45 * Ku, Pu / 1.2, 0, tolerance);
        const auto pid = tuned("ziegler_nichols_ultimate", plant);
        expect_settings(pid, 0.6 * Ku, Pu / 2, Pu / 8, tolerance);
        EXPECT_EQ(pid->controller.filter.type, FilterType::derivative);
        EXPECT_NEAR(pid->controller.filter.Tf, Pu / 80, 1e-6 * Pu);
        EXPECT_FALSE(pid->reduced_model);
        const auto variant = [&](const std::string& name_of) {
            return tuned("ziegler_nichols_ultimate", plant, {word("variant", name_of)});
        };
        expect_settings(variant("pessen"), 0.7 * Ku, 0.4 * Pu, 0.15 * Pu, tolerance);
        expect_settings(variant("some_overshoot"), Ku / 3, Pu / 2, Pu / 3, tolerance);
        expect_settings(variant("no_overshoot"), 0.2 * Ku, Pu / 2, Pu / 3, tolerance);
        expect_settings(tuned("tyreus_luyben", plant, kPI), Ku / 3.2, 2.2 * Pu, 0, tolerance);
        expect_settings(tuned("tyreus_luyben", plant), Ku / 2.2, 2.2 * Pu, Pu / 6.3, tolerance);
    }
}

TEST(AmigoUltimate, FollowsItsFormulasFromDeadTimeToIntegrator) {
    // kappa = 1/(K Ku): 1 for a dead time, 1/8 for three lags, 0 for an integrator.
    expect_settings(tuned("amigo_ultimate", kKnown[0].plant, kPI), 0.16 * 0.25, 6 / 5.5, 0, 1e-6);
    expect_settings(tuned("amigo_ultimate", kKnown[0].plant), 0.2 * 0.25, 0.6 * 6 / 3, 0, 1e-6);
    const double Pu = kKnown[3].Pu;
    expect_settings(tuned("amigo_ultimate", kKnown[3].plant, kPI), 0.16 * 8, Pu / (1 + 4.5 / 8), 0, 1e-6);
    const auto pid = tuned("amigo_ultimate", kKnown[3].plant);
    expect_settings(pid, (0.3 - 0.1 / 4096) * 8, 0.6 * Pu / 1.25, 0.15 * Pu * 0.875 / (1 - 0.95 / 8), 1e-6);
    EXPECT_EQ(pid->controller.filter.type, FilterType::measurement_second_order);
    expect_settings(tuned("amigo_ultimate", kKnown[1].plant), 0.3 * pi / 2, 0.6 * 8, 0.15 * 8, 1e-6);
}

TEST(UltimatePointOptions, GivenByHandTheyReplaceThePlantsOwn) {
    const Given by_hand{{"Ku", 10.0}, {"Pu", 2.0}};
    // A first-order lag has no ultimate point.
    const Fopdt lag{.K = 1, .T = 1, .L = 0};
    expect_settings(tuned("ziegler_nichols_ultimate", lag, by_hand), 6, 1, 0.25);
    expect_settings(tuned("tyreus_luyben", lag, by_hand), 10 / 2.2, 4.4, 2 / 6.3);
}

TEST(UltimatePointOptions, RelayTakesTheRecordedTests) {
    const Fopdt plant{.K = 1, .T = 1, .L = 1};
    TuningProblem problem{plant, *LinearPlant::make(plant), std::nullopt};
    const auto tune = find_method("ziegler_nichols_ultimate")->tune;
    const MethodOptions relay = test::options_of({word("ultimate", "relay")});
    const auto without = tune(problem, relay, {});
    ASSERT_FALSE(without);
    EXPECT_EQ(without.error().where, "ultimate");
    EXPECT_THAT(without.error().message, HasSubstr("there is no recorded relay test"));
    problem.relay_point = UltimatePoint{.Ku = 2, .Pu = 4};
    expect_settings(tune(problem, relay, {}), 1.2, 2, 0.5);
    // By default Ku and Pu are still those of the model.
    EXPECT_NE(tune(problem, {}, {})->controller.Kp, 1.2);
}

TEST(UltimatePointOptions, HalfAPointIsRefused) {
    const Fopdt plant{.K = 1, .T = 1, .L = 1};
    const auto refusal = [&](const Given& given) {
        const auto answer = tuned("ziegler_nichols_ultimate", plant, given);
        return answer ? std::string("tuned") : answer.error().where + ": " + answer.error().message;
    };
    EXPECT_EQ(refusal({{"Ku", 1.0}}), "Pu: Ku is given without Pu; give both or neither.");
    EXPECT_EQ(refusal({{"Pu", 1.0}}), "Ku: Pu is given without Ku; give both or neither.");
    EXPECT_THAT(refusal({{"Ku", 0.0}, {"Pu", 1.0}}), HasSubstr("Ku: Ku is 0; it must be"));
}

TEST(UltimateRules, AnUnstablePlantThatAGainStabilisesIsTunedWithAWarning) {
    const Fopdt plant{.K = -1, .T = -4, .L = 1};  // 1/(4 s - 1) e^(-s)
    for (const std::string id : {"ziegler_nichols_ultimate", "tyreus_luyben"}) {
        const auto answer = tuned(id, plant);
        ASSERT_TRUE(answer) << answer.error().message;
        EXPECT_TRUE(warns(*answer, "outside-validity"));
    }
}

}  // namespace
}  // namespace tunewright
