// Warnings and refusals of the method emulation, and its stop.
#include <gmock/gmock.h>

#include "engine/tuning/emulation/emulation_report.h"
#include "tests/engine/plant/nonlinear_plants.h"
#include "tests/engine/tuning/emulation_support.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

TEST(Emulation, SaysWhereAPidCannotFollow) {
    MethodOptions options = pendulum_step(0);
    set_range(options, "bounds/Kp", 0.5, 1);
    const auto answer = emulated(emulation_plant(pendulum()).problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_FALSE(answer->report_as<EmulationReport>()->fit.adequate);
    ASSERT_TRUE(has_warning(*answer, "cannot-emulate"));
    EXPECT_GT(answer->report_as<EmulationReport>()->fit.u_left, 0.1);
}

TEST(Emulation, WarnsOfUnstableZeroDynamics) {
    const Plant plant = Zpk{.K = -1, .zeros = {2.0}, .poles = {-1.0, -1.0}, .L = 0};
    const TuningProblem problem{plant, LinearPlant::make(plant).value(), std::nullopt, std::nullopt};
    MethodOptions options = step_of(1, 1, "PI");
    options.set("target/gamma", 2.0);
    const auto answer = emulated(problem, options);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_TRUE(has_warning(*answer, "unstable-zero-dynamics"));
    EXPECT_FALSE(answer->report_as<EmulationReport>()->zero_dynamics_stable);
}

struct Refusal {
    const char* why;
    std::vector<std::pair<std::string, OptionValue>> options;
    std::string where, sentence;
};

TEST(Emulation, WrongOptionsAreToldAtTheirPlace) {
    const EmulationPlant plant = emulation_plant(pendulum());
    const std::vector<Refusal> refusals = {
        {"degree",
         {{"target/gamma", 1.0}},
         "target/gamma",
         "gamma is for relative degree 1; the plant's relative degree is 2"},
        {"poles", {{"target/poles/0", -1.0}}, "target/poles", "A target of 1 poles is for relative degree 1"},
        {"unstable", {{"target/poles/0", 1.0}, {"target/poles/1", -1.0}}, "target/poles/0", "must be below 0"},
        {"pair",
         {{"target/poles/0/0", -1.0}, {"target/poles/0/1", 1.0}, {"target/poles/1", -1.0}},
         "target/poles",
         "conjugate pairs"},
        {"xi", {{"target/xi", 1.0}}, "target/tau_cl", "xi is given without tau_cl"},
        {"two targets", {{"target/gamma", 1.0}, {"target/tau_cl", 1.0}}, "target", "more than one is given"},
        {"state", {{"scenarios/0/initial/h", 1.0}}, "scenarios/0/initial/h", "its states are angle, speed"},
        {"parameter", {{"scenarios/0/parameters/g", 1.0}}, "scenarios/0/parameters/g", "g"},
        {"nothing", {{"scenarios/0/setpoint_step", 0.0}}, "scenarios/0/setpoint_step", "nothing would happen"},
        {"weights", {{"weights/wy", 0.0}, {"weights/wu", 0.0}}, "weights", "both 0"},
        {"remark6",
         {{"formulation", std::string("remark6")}, {"weights/wu", 0.0}},
         "weights/wu",
         "remark6 compares only u"},
        {"alpha", {{"bounds_from/alpha/0", 2.0}, {"bounds_from/alpha/1", 3.0}}, "bounds_from/alpha", "below 1"},
        {"method", {{"bounds_from/methods/0", std::string("emulation")}}, "bounds_from/methods/0", "emulation"},
        {"test", {{"bounds_from/test_step", 0.0}}, "bounds_from/test_step", "must not be 0"},
        {"horizon",
         {{"target/tau_cl", 0.2}, {"target/xi", 1.0}, {"horizon", 130.0}},
         "horizon",
         "would lie between two samples. It may be 128 at most"},
    };
    for (const Refusal& refusal : refusals) {
        SCOPED_TRACE(refusal.why);
        MethodOptions options;
        options.set("scenarios/0/setpoint_step", 0.1);
        for (const auto& [path, value] : refusal.options) options.set(path, value);
        const auto answer = emulated(plant.problem, options);
        ASSERT_FALSE(answer);
        EXPECT_EQ(answer.error().kind, ErrorKind::invalid_argument);
        EXPECT_EQ(answer.error().where, refusal.where);
        EXPECT_THAT(answer.error().message, HasSubstr(refusal.sentence));
    }
}

TEST(Emulation, APlantThatUDoesNotEnterAffinelyIsRefused) {
    NonlinearPlant plant = conical_tank();
    plant.equations = {{"h", "(q^2 - c*sqrt(h)/2)/(pi*k^2*h^2)"}};
    const auto answer = emulated(emulation_plant(plant).problem, {});
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().kind, ErrorKind::unsupported);
    EXPECT_TRUE(answer.error().where.starts_with("plant/"));
}

TEST(Emulation, AStepThatTheNonlinearControllerCannotMakeIsToldWithItsReason) {
    const EmulationPlant reactor = emulation_plant(cstr("CA"));
    MethodOptions options;
    options.set("target/tau_cl", 0.2);
    options.set("scenarios/0/setpoint_step", 0.45);
    const auto answer = emulated(reactor.problem, options);
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().where, "scenarios/0");
    EXPECT_THAT(answer.error().message, HasSubstr("The nonlinear controller itself cannot perform this step"));
}

TEST(Emulation, StoppedBeforeItBeginsItIsCancelled) {
    std::stop_source stop;
    stop.request_stop();
    const auto answer = emulated(emulation_plant(pendulum()).problem, pendulum_step(0), {stop.get_token(), {}, {}});
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().kind, ErrorKind::cancelled);
}

TEST(Emulation, StoppedWhileItSearchesItAnswersTheBestSoFar) {
    std::stop_source stop;
    double last = 0;
    const RunControl control{stop.get_token(),
                             [&](const Progress& progress) {
                                 EXPECT_GE(progress.fraction, last);
                                 last = progress.fraction;
                                 if (progress.best) stop.request_stop();
                             },
                             {}};
    const auto answer = emulated(emulation_plant(pendulum()).problem, pendulum_step(0), control);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_TRUE(answer->partial);
    EXPECT_GT(answer->controller.Kp, 0);
    ASSERT_EQ(answer->report_as<EmulationReport>()->scenarios.size(), 1u);
    EXPECT_TRUE(answer->report_as<EmulationReport>()->scenarios.front().ended.empty());
}

}  // namespace
}  // namespace tunewright
