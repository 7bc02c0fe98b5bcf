// The trade-off between servo and regulation of any controller: properties of the optima, scaling of figures, empty
// values.
#include "engine/tuning/arrieta/tradeoff_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/evaluation/evaluate.h"
#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using testing::HasSubstr;

const ParallelPid kPi{.Kp = 0.5, .Ki = 0.4};

double iae(const Fopdt& model, const IdealPid& pid, bool load) {
    EvaluateOptions options;
    options.points = 0;
    const auto e = evaluate(model, pid, options);
    const auto& value = load ? e->performance.load.IAE : e->performance.setpoint.IAE;
    return value.value_or(HUGE_VAL);
}

IdealPid moved(IdealPid pid, const std::array<double, 3>& by) {
    pid.Kp *= std::exp(by[0]);
    pid.Ti *= std::exp(by[1]);
    pid.Td *= std::exp(by[2]);
    pid.filter.Tf = pid.Td / 10;
    return pid;
}

// Between the tabulated starting points and at them.
TEST(TradeoffOptima, NoControllerNearbyIsBetterByMoreThanOneInTenThousand) {
    std::mt19937 random(7);
    std::normal_distribution<double> step(0, 0.02);
    for (const double tau : {0.03, 0.15, 0.5, 0.9, 1.6, 2.7, 9.0, 30.0}) {
        const Fopdt model{2, 3, 3 * tau};
        const auto ideal = ideal_controllers(model);
        ASSERT_TRUE(ideal);
        for (const bool load : {false, true}) {
            const IdealPid& best = load ? ideal->load : ideal->servo;
            const double J = iae(model, best, load);
            for (int i = 0; i < 60; ++i)
                EXPECT_GT(iae(model, moved(best, {step(random), step(random), step(random)}), load), J * (1 - 1e-4))
                    << tau << (load ? " load" : " servo");
        }
    }
}

TEST(TradeoffOptima, WhereThereIsNoneTheErrorSaysWhy) {
    EXPECT_THAT(ideal_controllers(Fopdt{1, 1, 0}).error().message, HasSubstr("no dead time"));
    EXPECT_THAT(ideal_controllers(Fopdt{1, -1, 1}).error().message, HasSubstr("stable first-order"));
    EXPECT_THAT(ideal_controllers(Fopdt{1, 0.01, 1}).error().message, HasSubstr("up to 50"));
    EXPECT_TRUE(ideal_controllers(Fopdt{1, 1, 1e-6}));
}

TEST(Tradeoffs, AreTimesWhateverTheGain) {
    const Fopdt unit{1, 1, 0.5}, other{-20, 60, 30};
    const auto a =
        Tradeoffs(unit).of(IdealPid{.Kp = 0.9, .Ti = 1.1, .Td = 0.1, .filter = {FilterType::derivative, 0.01}}, {});
    const auto b =
        Tradeoffs(other).of(IdealPid{.Kp = -0.045, .Ti = 66, .Td = 6, .filter = {FilterType::derivative, 0.6}}, {});
    EXPECT_NEAR(*b.model.J_r / 60 / *a.model.J_r, 1, 1e-6);
    EXPECT_NEAR(*b.model.J_d / 60 / *a.model.J_d, 1, 1e-6);
    EXPECT_NEAR(*b.model.J_rd / 60 / *a.model.J_rd, 1, 1e-6);
    EXPECT_NEAR(*b.model.Deg, *a.model.Deg, 1e-6);
    EXPECT_NEAR(*b.model.Ms / *a.model.Ms, 1, 1e-8);
}

TEST(Tradeoffs, OnAFirstOrderPlantModelAndPlantAreTheSame) {
    const auto entry = Tradeoffs(Fopdt{2, 3, 1}).of(kPi, {});
    EXPECT_EQ(*entry.model.J_rd, *entry.plant.J_rd);
    EXPECT_GT(*entry.model.J_r, *entry.model.J_r_opt);
    EXPECT_GT(*entry.model.J_d, *entry.model.J_d_opt);
    EXPECT_NEAR(*entry.model.J_rd,
                std::hypot(*entry.model.J_r - *entry.model.J_r_opt, *entry.model.J_d - *entry.model.J_d_opt), 1e-12);
    EXPECT_NEAR(*entry.model.Deg + *entry.model.I_perf, 1, 1e-15);
}

TEST(Tradeoffs, TheSteppedSizesOfTheEvaluationDoNotMatter) {
    TuningRequest request;
    request.subject = test::subject_of(Sopdt{.K = 2, .T1 = 10, .T2 = 4, .L = 3});
    request.tune = {MethodRequest{.method = "simc", .options = {}}};
    request.baseline = IdealPid{.Kp = 0.5, .Ti = 8};
    request.evaluate.points = 0;
    request.evaluate.tradeoff = true;
    const auto unit = tune(request, {});
    request.evaluate.setpoint_step = -5;
    request.evaluate.load_step = 0.1;
    request.evaluate.horizon = 3;
    const auto other = tune(request, {});
    for (std::size_t i = 0; i < 2; ++i) {
        ASSERT_TRUE(unit->controllers[i].report_as<TradeoffReport>()) << i;
        EXPECT_EQ(*unit->controllers[i].report_as<TradeoffReport>()->plant.J_rd,
                  *other->controllers[i].report_as<TradeoffReport>()->plant.J_rd);
    }
    // SIMC's PID works on the second-order plant itself; the trade-off is about a first-order model of it.
    EXPECT_TRUE(std::holds_alternative<Fopdt>(*unit->controllers[0].report_as<TradeoffReport>()->fopdt));
    request.evaluate.tradeoff = false;
    EXPECT_FALSE(tune(request, {})->controllers[0].report_as<TradeoffReport>());
}

void expect_empty(const TradeoffFigures& figures, const char* words) {
    EXPECT_FALSE(figures.J_r || figures.J_d || figures.J_rd || figures.J_r_opt || figures.J_d_opt || figures.I_perf ||
                 figures.Deg || figures.Ms);
    for (const Figure* figure : {&figures.J_r, &figures.J_d, &figures.J_rd, &figures.J_r_opt, &figures.J_d_opt,
                                 &figures.I_perf, &figures.Deg, &figures.Ms})
        EXPECT_THAT(figure->why, HasSubstr(words));
}

TEST(Tradeoffs, SayWhyTheyAreEmpty) {
    expect_empty(Tradeoffs(std::nullopt).of(kPi, {}).model, "frequency response");
    expect_empty(Tradeoffs(Ipdt{.K = 1, .L = 1}).of(kPi, {}).plant, "integrating plant");
    expect_empty(Tradeoffs(Ipdt{.K = 1, .L = 1}).of(kPi, {}).model, "integrating plant");
    expect_empty(Tradeoffs(Fopdt{1, 1, 1}).of(IdealPid{.Kp = 9, .Ti = 1}, {}).plant, "not stable");

    const auto no_integral = Tradeoffs(Fopdt{1, 1, 1}).of(IdealPid{.Kp = 0.5}, {}).plant;
    EXPECT_TRUE(no_integral.Ms && no_integral.J_r_opt && no_integral.J_d_opt);
    for (const Figure* figure :
         {&no_integral.J_r, &no_integral.J_d, &no_integral.J_rd, &no_integral.I_perf, &no_integral.Deg})
        EXPECT_THAT(figure->why, HasSubstr("Without integral action"));
}

// With a delta_r far above the step the nonlinear integral is a linear one.
TEST(Tradeoffs, OfANonlinearPidAreThoseOfItsResponsesToTheGivenSteps) {
    const Sopdt plant{.K = 2, .T1 = 10, .T2 = 4, .L = 3};
    EvaluateOptions options;
    options.setpoint_step = 3;
    options.load_step = -0.5;
    Tradeoffs tradeoffs(plant, options);
    const auto linear = tradeoffs.of(IdealPid{.Kp = 0.7, .Ti = 10}, {});
    const auto wide = tradeoffs.of(Npid{.Kp = 0.7, .Ti = 10, .delta_r = 3e4}, {});
    EXPECT_NEAR(*wide.plant.J_r / *linear.plant.J_r, 1, 1e-4);
    EXPECT_NEAR(*wide.plant.J_d / *linear.plant.J_d, 1, 1e-4);
    EXPECT_NEAR(*wide.model.J_rd / *linear.model.J_rd, 1, 1e-3);
    EXPECT_NEAR(*wide.plant.Ms / *linear.plant.Ms, 1, 1e-9);
    options.points = 0;
    const auto own = tradeoffs.of(Npid{.Kp = 0.7, .Ti = 10}, {});
    const auto evaluation = evaluate(plant, Npid{.Kp = 0.7, .Ti = 10}, options);
    EXPECT_NEAR(*own.plant.J_r / (*evaluation->performance.setpoint.IAE / 3), 1, 1e-12);
    EXPECT_NEAR(*own.plant.J_d / (*evaluation->performance.load.IAE / (0.5 * 2)), 1, 1e-12);
    EXPECT_GT(std::abs(*own.plant.J_r / *linear.plant.J_r - 1), 0.01) << "the integral sees less of a large error";
}

TEST(Tradeoffs, WithoutAModelThePlantKeepsItsOwnFigures) {
    const auto unstable = Tradeoffs(Fopdt{-1, -10, 1}).of(IdealPid{.Kp = 4, .Ti = 20}, {});
    EXPECT_TRUE(unstable.plant.J_r && unstable.plant.J_d && unstable.plant.Ms);
    const TradeoffFigures& f = unstable.plant;
    for (const Figure* figure : {&f.J_rd, &f.J_r_opt, &f.J_d_opt, &f.I_perf, &f.Deg})
        EXPECT_THAT(figure->why, HasSubstr("stable first-order"));

    const auto oscillating = Tradeoffs(OscillatorySopdt{1, 1, 0, 0.1}).of(ParallelPid{.Ki = 0.02}, {});
    expect_empty(oscillating.model, "undamped");

    const auto tiny = Tradeoffs(Fopdt{1, 1, 0.03}).of(kPi, {}).model;
    EXPECT_TRUE(tiny.J_rd && !tiny.I_perf && !tiny.Deg);
    EXPECT_THAT(tiny.I_perf.why, HasSubstr("Td < 0"));
}

TEST(Tradeoffs, WarnWhereTable2MissesItsLevel) {
    const auto entry_for = [](double L) {
        TuningRequest request;
        request.subject = test::subject_of(Fopdt{1, 1, L});
        request.tune = {MethodRequest{.method = "arrieta_degradation", .options = {}}};
        request.tune[0].options.set("degradation", 0.45);
        request.evaluate.points = 0;
        return tune(request, {})->controllers.front();
    };
    const auto warned = [](const TuningEntry& entry) {
        return std::ranges::any_of(entry.evaluation->warnings,
                                   [](const Warning& w) { return w.code == "degradation-missed"; });
    };
    EXPECT_TRUE(warned(entry_for(2)));
    EXPECT_FALSE(warned(entry_for(0.5)));
}

}  // namespace
}  // namespace tunewright
