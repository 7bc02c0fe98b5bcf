// Indices compared with an independent program (tests/data/indices), to infinity and up to various horizons, and with
// their own stated accuracy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/measured_response.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

using Json = nlohmann::json;

const Json& loops() {
    static const Json data = Json::parse(std::ifstream(test_data("indices/loops.json")));
    return data;
}

std::vector<std::complex<double>> roots_of(const Json& pairs) {
    std::vector<std::complex<double>> roots;
    for (const auto& pair : pairs) roots.emplace_back(pair[0], pair[1]);
    return roots;
}

Plant plant_of(const Json& plant) {
    return Zpk{.K = plant["K"], .zeros = roots_of(plant["zeros"]), .poles = roots_of(plant["poles"]), .L = plant["L"]};
}

ParallelPid controller_of(const Json& c) {
    const std::map<std::string, FilterType> types = {
        {"none", FilterType::none},
        {"derivative", FilterType::derivative},
        {"measurement_first_order", FilterType::measurement_first_order},
        {"measurement_second_order", FilterType::measurement_second_order}};
    return {.Kp = c["Kp"],
            .Ki = c["Ki"],
            .Kd = c["Kd"],
            .b = c["b"],
            .c = c["c"],
            .filter = {types.at(c["filter"].get<std::string>()), c["Tf"]}};
}

Evaluation figures_of_loop(const Json& loop, std::optional<double> horizon) {
    EvaluateOptions options;
    options.points = 0;
    options.horizon = horizon;
    const auto evaluation = evaluate(plant_of(loop["plant"]), Controller(controller_of(loop["controller"])), options);
    EXPECT_TRUE(evaluation.has_value()) << (evaluation ? "" : evaluation.error().message);
    return *evaluation;
}

double relative_error(const Json& wanted, const std::optional<double>& got) {
    if (!got) return HUGE_VAL;
    const double value = wanted;
    return value == *got ? 0 : std::abs(*got - value) / std::abs(value);
}

/// Checks one index: within its tolerance of the reference, and within the stated accuracy of the answer.
void hold(const Json& wanted, const std::optional<double>& got, const std::optional<double>& stated, double tolerance,
          const char* name) {
    const double error = relative_error(wanted, got);
    EXPECT_LE(error, tolerance) << name;
    ASSERT_TRUE(stated) << name;
    EXPECT_LE(error, std::max(*stated, 1e-6)) << name;
}

template <class Figures>
void hold_indices(const Json& wanted, const Figures& figures, const IndexErrors& stated) {
    hold(wanted["IAE"], figures.IAE, stated.IAE, kMaxIaeError, "IAE");
    hold(wanted["ISE"], figures.ISE, stated.ISE, kMaxIseError, "ISE");
    hold(wanted["ITAE"], figures.ITAE, stated.ITAE, kMaxItaeError, "ITAE");
    hold(wanted["TV"], figures.TV, stated.TV, kMaxTvError, "TV");
}

/// Checks a figure that must exist in both or in neither.
void same(const Json& wanted, const std::optional<double>& got, double tolerance, const char* name) {
    ASSERT_EQ(wanted.is_null(), !got.has_value()) << name;
    if (got) {
        EXPECT_LE(relative_error(wanted, got), tolerance) << name;
    }
}

void hold_all(const Json& wanted, const Evaluation& e) {
    const auto& [setpoint, load, noise] = e.performance;
    hold_indices(wanted["setpoint"], setpoint, e.verification.setpoint_errors);
    hold_indices(wanted["load"], load, e.verification.load_errors);
    EXPECT_NEAR(*setpoint.overshoot_percent, wanted["setpoint"]["overshoot_percent"].get<double>(), 1e-3);
    same(wanted["setpoint"]["settling_time"], setpoint.settling_time, 1e-5, "settling time");
    same(wanted["setpoint"]["rise_time"], setpoint.rise_time, 1e-5, "rise time");
    same(wanted["load"]["peak"], load.peak, 1e-5, "peak");
    same(wanted["load"]["recovery_time"], load.recovery_time, 1e-5, "recovery time");
}

TEST(IndexAccuracy, IsAsPromisedOnLoopsOfAllKinds) {
    for (const Json& loop : loops()) {
        SCOPED_TRACE(loop.dump().substr(0, 300));
        const auto e = figures_of_loop(loop, std::nullopt);
        hold_all(loop, e);
        for (const auto& warning : e.warnings) ADD_FAILURE() << warning.detail;
    }
}

TEST(IndexAccuracy, IsAsPromisedUpToAnyHorizon) {
    for (const Json& loop : loops())
        for (const Json& cut : loop["cuts"]) {
            SCOPED_TRACE(loop.dump().substr(0, 300) + " up to " + cut["horizon"].dump());
            hold_all(cut, figures_of_loop(loop, cut["horizon"].get<double>()));
        }
}

EvaluateOptions up_to(std::optional<double> horizon) {
    EvaluateOptions options;
    options.points = 0;
    options.horizon = horizon;
    return options;
}

TEST(IndexAccuracy, ActuatorLimitsThatAreNeverMetChangeNothing) {
    // The same responses by two programs: one for three linear systems, one for one.
    const Fopdt plant{.K = 1, .T = 10, .L = 3};
    for (const IdealPid& pid : {IdealPid{.Kp = 1, .Ti = 40},
                                IdealPid{.Kp = 2, .Ti = 8, .Td = 1, .b = 0.5, .filter = {FilterType::derivative, 0.1}}})
        for (const std::optional<double> horizon : {std::optional<double>(20), std::optional<double>(4.7),
                                                    std::optional<double>(61.3), std::optional<double>()}) {
            auto options = up_to(horizon);
            const auto free = evaluate(plant, pid, options);
            options.actuator = ActuatorLimits{-99, 99};
            const auto limited = evaluate(plant, pid, options);
            ASSERT_TRUE(free && limited);
            const auto near = [](const std::optional<double>& a, const std::optional<double>& b) {
                ASSERT_EQ(a.has_value(), b.has_value());
                if (a) {
                    EXPECT_NEAR(*a, *b, 2e-6 * std::abs(*a));
                }
            };
            const auto &a = free->performance, &b = limited->performance;
            near(a.setpoint.IAE, b.setpoint.IAE);
            near(a.setpoint.ISE, b.setpoint.ISE);
            near(a.setpoint.ITAE, b.setpoint.ITAE);
            near(a.setpoint.TV, b.setpoint.TV);
            near(a.setpoint.settling_time, b.setpoint.settling_time);
            near(a.load.IAE, b.load.IAE);
            near(a.load.ISE, b.load.ISE);
            near(a.load.ITAE, b.load.ITAE);
            near(a.load.TV, b.load.TV);
            near(a.load.recovery_time, b.load.recovery_time);
        }
}

TEST(IndexAccuracy, BeforeTheDeadTimeNothingHasHappened) {
    const auto e = evaluate(Fopdt{.K = 1, .T = 10, .L = 3}, IdealPid{.Kp = 2, .Ti = 8}, up_to(2.9999));
    ASSERT_TRUE(e);
    EXPECT_EQ(*e->performance.load.IAE, 0);
    EXPECT_EQ(*e->performance.load.TV, 0);
    EXPECT_NEAR(*e->performance.setpoint.IAE, 2.9999, 1e-12);
    EXPECT_NEAR(*e->performance.setpoint.ITAE, 2.9999 * 2.9999 / 2, 1e-12);
    EXPECT_NEAR(*e->performance.setpoint.TV, 2 + 2 * 2.9999 / 8, 1e-12);
}

TEST(IndexAccuracy, ATailWithoutChangeOfSignIsTheIntegralOfErrorHoweverSlow) {
    // Unit load: the integral of the error is Ti/Kp. The slow pole is near -1/Ti, and most of the response is
    // y = (1/Kp) e^(-t/Ti), of first moment Ti^2/Kp.
    for (const double Ti : {327.0, 1e4, 1e5, 1e7})
        for (const double Kp : {0.5, 2.0, 5.0}) {
            SCOPED_TRACE(Ti);
            const auto e = evaluate(Zpk{.K = 0.1, .zeros = {}, .poles = {0.0, -1.0}, .L = 1},
                                    IdealPid{.Kp = Kp, .Ti = Ti, .Td = 1, .filter = {FilterType::derivative, 0.1}},
                                    up_to(std::nullopt));
            ASSERT_TRUE(e);
            ASSERT_TRUE(e->performance.load.IAE && e->performance.load.ITAE && e->performance.setpoint.IAE);
            EXPECT_NEAR(*e->performance.load.IAE / (Ti / Kp), 1, 1e-12);
            EXPECT_TRUE(e->verification.load_error_keeps_sign.value_or(false));
            EXPECT_NEAR(*e->performance.load.ITAE / (Ti * Ti / Kp), 1, 1e-5 + 25 / Ti);
            // A tail of 10^7 dead times reduces the set-point response of two integrators to rounding errors, and the
            // answer says so.
            for (const auto& warning : e->warnings)
                if (Ti < 1e7) ADD_FAILURE() << warning.detail;
        }
}

TEST(IndexAccuracy, AnErrorThatChangesSignIsNotSaidToKeepIt) {
    const auto e = evaluate(Fopdt{.K = 1, .T = 10, .L = 3}, IdealPid{.Kp = 3, .Ti = 6}, up_to(std::nullopt));
    ASSERT_TRUE(e);
    EXPECT_FALSE(e->verification.load_error_keeps_sign.value_or(true));
    EXPECT_GT(*e->performance.load.IAE, 6.0 / 3);
}

}  // namespace
}  // namespace tunewright
