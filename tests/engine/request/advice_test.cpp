// Findings with advice: the advice is followed, and has the stated effect. Other findings state facts, which are also
// checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stop_token>

#include "engine/controller/product/catalogue.h"
#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/evaluate_sampled.h"
#include "engine/request/evaluate_all.h"
#include "engine/request/tune.h"
#include "engine/request/verdict/verdict.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/sampled/sampled_response.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

using verdict::Finding;
using verdict::Level;

const Finding* said(const TuningEntry& entry, const std::string& code) {
    const auto found = std::ranges::find(entry.verdict, code, &Finding::code);
    return found != entry.verdict.end() ? &*found : nullptr;
}

TuningRequest advice_request(const Plant& plant, const std::string& method, double M = 0) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.tune = {{.method = method, .options = {}}};
    if (M > 0) request.tune[0].options.set("Ms", M), request.tune[0].options.set("Mt", M);
    request.evaluate.points = 0;
    return request;
}

std::vector<TuningEntry> entries_of(const TuningRequest& request) {
    auto result = tune(request, {});
    EXPECT_TRUE(result) << result.error().message;
    return result ? std::move(result->controllers) : std::vector<TuningEntry>{};
}

constexpr verdict::GivenSteps kBothGiven{.setpoint = true, .load = true};

TuningEntry evaluated(const Plant& plant, const Controller& controller, EvaluateOptions options = {},
                      const verdict::GivenSteps& given_steps = kBothGiven) {
    options.points = 0;
    auto result = evaluate_all(test::subject_of(plant), {controller}, options, {}, {}, {}, nullptr, given_steps);
    EXPECT_TRUE(result) << result.error().message;
    return std::move(result->controllers.front());
}

class Chance {
public:
    explicit Chance(unsigned seed) : random_(seed) {}
    double log_between(double low, double high) {
        return low * std::pow(high / low, std::uniform_real_distribution<>()(random_));
    }

private:
    std::mt19937 random_;
};

TEST(Advice, AShorterFilterIsTriedBeforeItIsNamed) {
    Chance any(4);
    int made = 0, advised = 0;
    for (int i = 0; i < 30; ++i) {
        Plant plant = TransferFunction{.num = {1}, .den = {any.log_between(1, 20), any.log_between(5, 20), 1}, .L = 0};
        if (i % 3 == 1)
            plant = OscillatorySopdt{.K = 1, .T = 1, .zeta = any.log_between(0.02, 0.5), .L = any.log_between(0.1, 2)};
        if (i == 0) plant = OscillatorySopdt{.K = 1, .T = 1, .zeta = 0.0275, .L = 1};
        const auto request = advice_request(plant, "robust", any.log_between(1.3, 2));
        const auto result = tune(request, {});
        if (!result || !result->controllers[0].evaluation) continue;
        const Finding* finding = said(result->controllers[0], "filter-rules");
        made += finding != nullptr;
        if (finding == nullptr) continue;
        EXPECT_EQ(finding->text.find("With half of it") != std::string::npos, finding->figures.contains("shorter_Tf"));
        if (!finding->figures.contains("shorter_Tf")) continue;
        ++advised;
        auto again = request;
        again.tune[0].options.set("filter/Tf", finding->figures.at("shorter_Tf"));
        const auto entries = entries_of(again);
        const double IAE = *entries.at(0).evaluation->performance.load.IAE;
        EXPECT_NEAR(IAE / finding->figures.at("shorter_load_IAE"), 1, 1e-6);
        EXPECT_LT(1.05 * IAE, finding->figures.at("load_IAE"));
    }
    EXPECT_GT(made, 5);
    EXPECT_GT(advised, 3);
}

// h is the plant's step response without its dead time: K (L - T (1 - e^(-L/T))) of first order, K L of a dead time.
TEST(Advice, TheLeastLoadIaeOfADeadTimeIsBelowThatOfEveryController) {
    for (const double L : {2.0, 5.0, 25.0, 400.0}) {
        for (const double K : {0.3, -20.0}) {
            auto request = advice_request(Fopdt{.K = K, .T = 1, .L = L}, "all");
            request.evaluate.load_step = -2;
            int seen = 0;
            for (const TuningEntry& entry : entries_of(request)) {
                if (!entry.evaluation) continue;
                const Finding* finding = said(entry, "dead-time-rules");
                if (finding == nullptr || !finding->figures.contains("least_load_IAE")) continue;
                ++seen;
                const double min = finding->figures.at("least_load_IAE");
                EXPECT_NEAR(min / (2 * std::abs(K) * (L - (1 - std::exp(-L)))), 1, 1e-8);
                EXPECT_GT(*entry.evaluation->performance.load.IAE, min * (1 - 1e-6)) << entry.title;
            }
            EXPECT_GT(seen, 10);
        }
    }
    const TuningEntry alone =
        evaluated(TransferFunction{.num = {3}, .den = {1}, .L = 4}, IdealPid{.Kp = 0.02, .Ti = 0.5});
    ASSERT_NE(said(alone, "dead-time-rules"), nullptr);
    EXPECT_NEAR(said(alone, "dead-time-rules")->figures.at("least_load_IAE"), 12, 1e-9);
}

TEST(Advice, WhatKeepsAnOvershootKeepsIt) {
    Chance any(9);
    int weights = 0, lags = 0;
    for (int i = 0; i < 40; ++i) {
        const double L = any.log_between(0.05, 3);
        Plant plant = Fopdt{.K = 2, .T = 1, .L = L};
        if (i % 3 == 1) plant = Ipdt{.K = 1, .L = L};
        if (i % 3 == 2) plant = Sopdt{.K = 1, .T1 = 1, .T2 = 0.6, .L = L};
        for (const char* method : {"ziegler_nichols_ultimate", "simc", "tyreus_luyben"}) {
            for (const TuningEntry& entry : entries_of(advice_request(plant, method))) {
                const Finding* finding = entry.evaluation ? said(entry, "overshoot") : nullptr;
                if (finding == nullptr || !finding->figures.contains("kept_percent")) continue;
                IdealPid pid = std::get<IdealPid>(entry.evaluation->controller);
                if (finding->figures.contains("b")) pid.b = finding->figures.at("b"), ++weights;
                if (finding->figures.contains("setpoint_lag"))
                    pid.setpoint_lag = finding->figures.at("setpoint_lag"), ++lags;
                const TuningEntry cured = evaluated(plant, pid);
                EXPECT_LE(*cured.evaluation->performance.setpoint.overshoot_percent,
                          finding->figures.at("kept_percent") + 0.02)
                    << entry.title << " on plant " << i;
                EXPECT_EQ(*cured.evaluation->performance.load.IAE, *entry.evaluation->performance.load.IAE);
            }
        }
    }
    EXPECT_GT(weights, 10);
    EXPECT_GT(lags, 5);
}

TEST(Advice, ALongerFilterDoesWhatIsSaidOfIt) {
    const Fopdt plant{.K = 1, .T = 10, .L = 1};
    int advised = 0;
    for (const double Tf : {0.002, 0.005, 0.01}) {
        for (const FilterType type : {FilterType::none, FilterType::derivative, FilterType::measurement_second_order}) {
            IdealPid pid{.Kp = 4, .Ti = 8, .Td = 0.4, .filter = {type, type == FilterType::none ? 0 : Tf}};
            const TuningEntry entry = evaluated(plant, pid);
            const Finding* finding = said(entry, type == FilterType::none ? "no-filter" : "noise-gain");
            ASSERT_NE(finding, nullptr);
            if (!finding->figures.contains("longer_Tf")) continue;
            ++advised;
            pid.filter = {type == FilterType::none ? FilterType::derivative : type, finding->figures.at("longer_Tf")};
            const TuningEntry longer = evaluated(plant, pid);
            EXPECT_NEAR(*longer.evaluation->robustness.Mks / finding->figures.at("filtered_Mks"), 1, 1e-9);
            EXPECT_NEAR(*longer.evaluation->robustness.Ms / finding->figures.at("filtered_Ms"), 1, 1e-9);
            EXPECT_LT(*longer.evaluation->robustness.Ms, 1.7);
            if (entry.evaluation->robustness.Mks) {
                EXPECT_LT(*longer.evaluation->robustness.Mks, 0.7 * *entry.evaluation->robustness.Mks);
            }
        }
    }
    EXPECT_GT(advised, 4);
}

// |C S| of a PI is 1/K at frequency 0, however small its Kp: that is not noise.
TEST(Advice, ThePeakAtRestIsNoNoiseGain) {
    for (const double Kp : {1e-4, 0.01, 0.04}) {
        const TuningEntry entry = evaluated(Fopdt{.K = 1, .T = 1, .L = 25}, IdealPid{.Kp = Kp, .Ti = 60 * Kp});
        ASSERT_GT(*entry.evaluation->robustness.Mks, 20 * Kp);
        EXPECT_EQ(said(entry, "noise-gain"), nullptr) << Kp;
    }
}

// The actuator can produce the largest stated steps, but not steps one per cent larger.
TEST(Advice, AnActuatorThatIsTooSmallIsNamedWithTheStepsThatItCarries) {
    EvaluateOptions options;
    options.actuator = ActuatorLimits{-0.3, 0.4};
    const Fopdt plant{.K = 2, .T = 10, .L = 3};
    const IdealPid pid{.Kp = 0.8, .Ti = 8};
    for (const double sign : {1.0, -1.0}) {
        options.setpoint_step = options.load_step = sign;
        const TuningEntry entry = evaluated(plant, pid, options);
        const Finding* finding = said(entry, "actuator-too-small");
        ASSERT_NE(finding, nullptr);
        EXPECT_EQ(finding->level, Level::warning);
        for (const char* code : {"no-integral", "not-settling"}) EXPECT_EQ(said(entry, code), nullptr) << code;
        const double r = finding->figures.at("largest_setpoint_step"), d = finding->figures.at("largest_load_step");
        EXPECT_NEAR(r, sign > 0 ? 0.8 : -0.6, 1e-12);
        EXPECT_NEAR(d, sign > 0 ? 0.3 : -0.4, 1e-12);
        const auto with = [&](double share) {
            EvaluateOptions other = options;
            other.setpoint_step = share * r;
            other.load_step = share * d;
            return evaluated(plant, pid, other);
        };
        EXPECT_EQ(said(with(0.99), "actuator-too-small"), nullptr);
        EXPECT_TRUE(with(0.99).evaluation->performance.load.IAE && with(0.99).evaluation->performance.setpoint.IAE);
        EXPECT_NE(said(with(1.01), "actuator-too-small"), nullptr);
        EXPECT_FALSE(with(1.01).evaluation->performance.load.IAE || with(1.01).evaluation->performance.setpoint.IAE);
    }
}

TEST(Advice, AnActuatorThatIsTooSmallCondemnsNoMethod) {
    auto request = advice_request(Fopdt{.K = 2, .T = 10, .L = 3}, "robust");
    request.tune.push_back({.method = "simc", .options = {}});
    request.evaluate.actuator = ActuatorLimits{-0.2, 0.2};
    request.given_steps = kBothGiven;
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->verdict.front().code, "take");
    EXPECT_EQ(result->controllers[0].verdict.front().code, "actuator-too-small");
    // It is bad if no controller holds y, for the same reason.
    request.subject = test::subject_of(Ipdt{.K = 1, .L = 1});
    const auto runaway = tune(request, {});
    ASSERT_TRUE(runaway);
    EXPECT_EQ(runaway->controllers[0].verdict.front().code, "actuator-too-small");
    EXPECT_EQ(runaway->controllers[0].verdict.front().level, Level::bad);
}

/// The request gives no size of a step: its sign alone must not decide.
TEST(Advice, AnAssumedStepThatTheActuatorDoesNotCarryIsANote) {
    const IdealPid pid{.Kp = 0.8, .Ti = 8};
    for (const Plant& plant : {Plant(Fopdt{.K = 2, .T = 10, .L = 3}), Plant(Ipdt{.K = 0.2, .L = 1})}) {
        EvaluateOptions options;
        options.actuator = ActuatorLimits{0, 100};  // u cannot be below its steady-state value
        for (const double load : {1.0, -1.0}) {
            options.load_step = load;
            const TuningEntry assumed = evaluated(plant, pid, options, {});
            EXPECT_NE(assumed.verdict.front().code, "actuator-too-small");
            const Finding* finding = said(assumed, "actuator-too-small");
            ASSERT_EQ(finding != nullptr, load > 0);
            if (finding == nullptr) continue;
            EXPECT_EQ(finding->level, Level::note);
            EXPECT_EQ(finding->figures.at("largest_load_step"), 0);
            EXPECT_GE(said(evaluated(plant, pid, options, {.load = true}), "actuator-too-small")->level,
                      Level::warning);
            EXPECT_EQ(said(evaluated(plant, pid, options, {.setpoint = true}), "actuator-too-small")->level,
                      Level::note);
        }
    }
}

/// A load that the actuator cannot compensate does not concern the set point, and does not hide findings about it.
TEST(Advice, AStepBeyondTheActuatorExcusesItsOwnResponseAlone) {
    EvaluateOptions options;
    options.actuator = ActuatorLimits{-0.4, 2};
    auto entry = evaluated(Fopdt{.K = 2, .T = 10, .L = 3}, IdealPid{.Kp = 0.8, .Ti = 8}, options, {});
    ASSERT_NE(said(entry, "actuator-too-small"), nullptr);
    EXPECT_EQ(said(entry, "not-settling"), nullptr);
    const AnalysedPlant subject = test::subject_of(Fopdt{.K = 2, .T = 10, .L = 3});
    entry.evaluation->performance.setpoint.settling_time = no_figure("It does not settle.");
    std::vector<TuningEntry> entries{entry};
    verdict::judge(entries, {subject, options, {}});
    EXPECT_NE(said(entries[0], "not-settling"), nullptr);
}

TEST(Advice, WhatStaysWithinTheOvershootAskedForIsNoFinding) {
    int within = 0;
    for (const double asked : {10.0, 20.0, 40.0, 60.0}) {
        for (const Plant& plant : {Plant(Fopdt{.K = 2, .T = 10, .L = 3}), Plant(Ipdt{.K = 1, .L = 1})}) {
            auto request = advice_request(plant, "robust", 1.8);
            request.tune[0].options.set("setpoint/overshoot", asked);
            for (const TuningEntry& entry : entries_of(request)) {
                if (!entry.evaluation) continue;
                const double reached = *entry.evaluation->performance.setpoint.overshoot_percent;
                within += reached > 15 && reached <= asked + 0.05;
                EXPECT_EQ(said(entry, "overshoot") != nullptr, reached > asked + 0.05)
                    << reached << " where " << asked << " was asked for";
            }
        }
    }
    EXPECT_GE(within, 3);
}

/// A search that was stopped finds nothing, and the verdict is given without it.
TEST(Advice, ACureWhoseSearchIsStoppedIsNone) {
    auto request = advice_request(TransferFunction{.num = {1}, .den = {10, 11, 1}, .L = 0}, "robust", 1.4);
    const auto result = tune(request, {});
    ASSERT_TRUE(result);
    const Finding* finding = said(result->controllers[0], "filter-rules");
    ASSERT_NE(finding, nullptr);
    ASSERT_TRUE(finding->figures.contains("shorter_Tf"));
    const AnalysedPlant& subject = *request.subject;
    const TuningProblem problem{*subject.nominal(), *subject.linear(), {}, {}};
    std::stop_source source;
    verdict::Context context{subject, request.evaluate, {}, 0, nullptr, &problem, {}, {}};
    context.control.stop = source.get_token();
    std::vector<TuningEntry> entries{result->controllers[0]};
    verdict::judge(entries, context);
    EXPECT_TRUE(said(entries[0], "filter-rules")->figures.contains("shorter_Tf"));
    source.request_stop();
    verdict::judge(entries, context);
    ASSERT_NE(said(entries[0], "filter-rules"), nullptr);
    EXPECT_FALSE(said(entries[0], "filter-rules")->figures.contains("shorter_Tf"));
    EXPECT_EQ(entries[0].verdict.front().code, result->controllers[0].verdict.front().code);
}

TEST(Advice, OnEquationsTheStepThatTheActuatorCarriesIsWhereTheyComeToRest) {
    // y = x^2, at rest x = u: from u 1 to 1.2, y goes from 1 to 1.44.
    NonlinearPlant plant{.states = {{"x", 1}},
                         .parameters = {},
                         .equations = {{"x", "u - x"}},
                         .input = {.name = "u", .nominal = 1, .min = 0.0, .max = 1.2},
                         .output = "x^2",
                         .L = 0.1};
    EvaluateOptions options;
    options.points = 0;
    options.setpoint_step = 0.6;
    options.load_step = 0.1;
    const auto result = evaluate_all(test::subject_of(plant), {IdealPid{.Kp = 0.5, .Ti = 0.5}}, options, {}, {}, {},
                                     nullptr, kBothGiven);
    ASSERT_TRUE(result) << result.error().message;
    const Finding* finding = said(result->controllers[0], "actuator-too-small");
    ASSERT_NE(finding, nullptr);
    EXPECT_NEAR(finding->figures.at("largest_setpoint_step"), 0.44, 1e-9);
}

/// Overshoot in percent if the set point changes in many small steps, over this duration together.
double overshoot_of_steps(const LinearPlant& plant, const SampledPid& law, double duration) {
    constexpr int kSteps = 100, kTimes = 20000;
    const StepResponse step = simulate_sampled(plant, law, {}, {1, 0}, {});
    const double horizon = step.nodes.back().t, spacing = horizon / kTimes;
    const auto y = sampled(step.nodes, horizon, kTimes + 1);
    double max = 0;
    for (double t = 0; t < horizon; t += spacing) {
        double sum = 0;
        for (int k = 0; k < kSteps; ++k) {
            const double since = t - (k + 0.5) * duration / kSteps;
            if (since > 0) sum += y[static_cast<std::size_t>(std::lround(since / spacing))].first / kSteps;
        }
        max = std::max(max, sum);
    }
    return 100 * (max - 1);
}

// A firmware without weight and filter: the finding has the overshoot of the step, the limit, and the lag and the
// ramp that keep it. A limit that the request did not set is the method's own: above it there is a finding, and up to a
// quarter of the step no doubt.
void expect_overshoot_told(std::optional<double> asked) {
    int apart = 0;
    for (const std::string product : {"klipper", "marlin", "siemens_fb41_cont_c", "esphome_pid"}) {
        auto request = advice_request(Fopdt{.K = 1, .T = 100, .L = 30}, "robust", 1.6);
        if (asked) request.tune[0].options.set("setpoint/overshoot", *asked);
        const double limit = asked.value_or(5);
        const auto* known = product::find(product);
        ASSERT_NE(known, nullptr) << product;
        device::DeviceModel device;
        device.product = known;
        device.context = product::Context::with_spans({.y_low = 0, .y_high = 200, .u_low = 0, .u_high = 100}, 1);
        device.context.loop_clock_s = 1;
        device.Ts = 1;
        request.device = device;
        const auto result = tune(request, {});
        if (!result || !result->controllers[0].on_device) continue;
        const TuningEntry& entry = result->controllers[0];
        const double reached = *entry.on_device->loop.performance.setpoint.overshoot_percent;
        const Finding* finding = said(entry, "overshoot");
        EXPECT_EQ(finding != nullptr, reached > limit + 0.05) << product << " reaches " << reached;
        if (finding == nullptr) continue;
        ++apart;
        EXPECT_EQ(finding->figures.at("overshoot_percent"), reached);
        EXPECT_EQ(finding->figures.at(asked ? "asked_percent" : "design_percent"), limit);
        EXPECT_EQ(finding->figures.size(), 5u) << finding->text;
        const double doubted_from = asked ? *asked + 2 : 25;
        EXPECT_EQ(finding->level, reached > doubted_from ? Level::warning : Level::note) << product;
        EXPECT_EQ(entry.verdict.front().level == Level::good, reached <= doubted_from) << product;
        ASSERT_TRUE(finding->figures.contains("setpoint_lag")) << product << finding->text;
        SampledPid law = entry.on_device->fitted.law;
        law.gains.setpoint_lag = finding->figures.at("setpoint_lag");
        const auto cured = evaluate_sampled(*request.subject, law, {}, request.evaluate);
        ASSERT_TRUE(cured);
        EXPECT_LE(*cured->performance.setpoint.overshoot_percent, limit + 0.02) << product;
        EXPECT_NEAR(overshoot_of_steps(*request.subject->linear(), entry.on_device->fitted.law,
                                       finding->figures.at("setpoint_ramp")),
                    limit, 0.1)
            << product;
    }
    EXPECT_GE(apart, 1);
}

TEST(Advice, OvershootAskedAndReachedAreNotApartWithoutAWord) {
    for (const double asked : {2., 5., 12., 24.}) expect_overshoot_told(asked);
}

TEST(Advice, AnOvershootAboveTheMethodsOwnLimitIsAWordAndNoDoubt) { expect_overshoot_told({}); }

}  // namespace
}  // namespace tunewright
