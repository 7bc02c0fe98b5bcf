// The start of a record, limits of the input, false readings, and the effect of an excess lag on the gain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/evaluation/evaluate.h"
#include "engine/identification/fit/residual_noise.h"
#include "engine/identification/fit/response.h"
#include "engine/identification/identify.h"
#include "engine/identification/record/data_quality.h"
#include "engine/identification/record/record_kind.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/request/tune.h"
#include "tests/engine/identification/simulated_record.h"

namespace tunewright {
namespace {

using namespace tunewright::testing;
using ::testing::HasSubstr;

double static_gain(const IdentifiedModel& model) { return LinearPlant::make(model.plant)->low_frequency_gain(); }

bool noted(const IdentifiedModel& model, const std::string& words) {
    return std::ranges::any_of(model.data_quality.notes,
                               [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

/// Lags in a row by superposition of exponentials; all different.
StepCurve lags(double K, std::vector<double> T) {
    return [=](double t) {
        if (t <= 0) return 0.0;
        double y = 1;
        for (std::size_t i = 0; i < T.size(); ++i) {
            double share = 1;
            for (std::size_t k = 0; k < T.size(); ++k) share *= k == i ? 1 : T[i] / (T[i] - T[k]);
            y -= share * std::exp(-t / T[i]);
        }
        return K * y;
    };
}

TEST(Start, ARecordAtRestStaysAtRestHoweverManyLagsFollow) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Record record = simulate(even_times(600, 1), 0, 50, {{10, 5}}, lags(1.4, {80, 19, 17, 15, 13}));
        add_noise(record, 0.03, seed);
        const auto model = identify(record, {}, {});
        ASSERT_TRUE(model);
        EXPECT_NEAR(static_gain(*model), 1.4, 0.02 * 1.4) << seed << model->choice_reason;
        EXPECT_FALSE(noted(*model, "does not start at rest")) << seed;
    }
}

/// A damaged cell or the rounding of u is not a second move, after which the initial state would be free.
TEST(Start, JitterOfUIsNoSecondMove) {
    Record record = simulate(even_times(300, 1), 0, 10, {{1, 5}}, first_order(1.4, 30, 2));
    add_noise(record, 0.02, 5);
    EXPECT_EQ(start_of(*clean_record(record), false, 0.001), RecordStart::at_rest);
    record.u[150] += 0.01;
    EXPECT_EQ(start_of(*clean_record(record), false, 0.001), RecordStart::at_rest);
    record.u[150] += 1;
    EXPECT_EQ(start_of(*clean_record(record), false, 0.001), RecordStart::unseen);
}

TEST(Start, TellsRestFromMotion) {
    const auto start = [](const Record& record) { return start_of(*clean_record(record), false, 0.001); };
    Record resting = simulate(even_times(300, 1), 0, 0, {{60, 1}}, first_order(1, 20, 2));
    add_noise(resting, 0.01, 3, 0.95);
    EXPECT_EQ(start(resting), RecordStart::at_rest);
    const Record moving = simulate(even_times(300, 1), 3, 0, {{0, 1}, {60, 2}}, first_order(1, 20, 2));
    EXPECT_EQ(start(moving), RecordStart::moving);
    Record given = moving;
    given.u0 = 3;
    EXPECT_EQ(start(given), RecordStart::at_rest);
    EXPECT_EQ(start(simulate(even_times(300, 1), 0, 0, {{1, 1}, {60, 2}}, first_order(1, 20, 2))), RecordStart::unseen);
}

TEST(Records, AMoveWithTheLastRowIsNone) {
    Record record = simulate(even_times(200, 0.5), 0, 0, {{20, 1}}, first_order(2, 8, 1));
    record.u.back() = 0;
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    EXPECT_EQ(model->data_quality.steps, 1);
    EXPECT_EQ(model->data_quality.kind, RecordKind::step);
    EXPECT_TRUE(model->data_quality.settled);
    EXPECT_TRUE(noted(*model, "1 change of u at the last sample removed"));
}

TEST(Records, MovesOfUInGapsArePlacedAtTheMissingRows) {
    // A relay's square wave of about nine rows per half period; every third move is among missing rows.
    Steps moves;
    std::vector<double> t;
    std::mt19937 random(5);
    for (double time = 20; time < 380; time += 8 + static_cast<double>(random() % 3))
        moves.emplace_back(time, moves.size() % 2 == 0 ? 1 : -0.6);
    for (int i = 0; i < 400; ++i) {
        const bool lost = std::ranges::any_of(moves, [&, k = 0](const auto& move) mutable {
            return k++ % 3 == 0 && i >= move.first && i < move.first + 3;
        });
        if (!lost) t.push_back(i);
    }
    Record record = simulate(t, 0, 10, moves, first_order(2, 6, 1.5));
    add_noise(record, 0.01, 11);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    EXPECT_NEAR(static_gain(*model), 2, 0.03 * 2) << model->choice_reason;
    EXPECT_GT(model->fit_percent, 97);
    EXPECT_TRUE(noted(*model, "happened where rows are missing"));
}

bool warned(const IdentifiedModel& model, const std::string& code) {
    return std::ranges::any_of(model.warnings, [&](const Warning& w) { return w.code == code; });
}

TEST(Records, ADeadTimeThatMissingRowsHideIsAsOpenAsTheyAreLong) {
    // u moves at 300; the rows from `from` to `to` are missing.
    const auto recorded = [](double from, double to) {
        Record whole = simulate(even_times(1200, 1), 50, 100, {{300, 51}}, first_order(2, 30, 25));
        add_noise(whole, 0.02, 4);
        Record record;
        for (std::size_t i = 0; i < whole.t.size(); ++i) {
            if (whole.t[i] > from && whole.t[i] < to) continue;
            record.t.push_back(whole.t[i]);
            record.u.push_back(whole.u[i]);
            record.y.push_back(whole.y[i]);
        }
        return record;
    };
    for (const auto& [from, to] : {std::pair{294.0, 325.0}, {299.0, 330.0}, {270.0, 301.0}}) {
        const auto model = identify(recorded(from, to), {}, {});
        ASSERT_TRUE(model);
        const auto* plant = std::get_if<Fopdt>(&model->plant);
        ASSERT_NE(plant, nullptr);
        EXPECT_NEAR(plant->L, 25, 15.5) << from;
        EXPECT_NEAR(model->standard_errors.at("L"), 30 / std::sqrt(12.0), 0.2) << from;
        EXPECT_NEAR(plant->T, 30, 0.5) << from;
        EXPECT_TRUE(warned(*model, "unseen-move")) << from;
    }
    // A recorder that writes on change: the step is the first row for a long time, at its own time.
    const Record dense = simulate(even_times(1200, 1), 50, 100, {{300, 51}}, first_order(2, 30, 25));
    Record on_change;
    for (std::size_t i = 0; i < dense.t.size(); ++i) {
        const bool moved = i == 0 || dense.u[i] != on_change.u.back() || dense.y[i] - on_change.y.back() > 0.002;
        if (!moved) continue;
        on_change.t.push_back(dense.t[i]);
        on_change.u.push_back(dense.u[i]);
        on_change.y.push_back(dense.y[i]);
    }
    const auto exact = identify(on_change, {}, {});
    ASSERT_TRUE(exact);
    EXPECT_NEAR(std::get<Fopdt>(exact->plant).L, 25, 0.5);
    EXPECT_FALSE(warned(*exact, "unseen-move"));
    const auto elsewhere = identify(recorded(500, 540), {}, {});
    ASSERT_TRUE(elsewhere);
    EXPECT_NEAR(std::get<Fopdt>(elsewhere->plant).L, 25, 0.5);
    EXPECT_FALSE(warned(*elsewhere, "unseen-move"));
}

TEST(Records, ALoadFarBeyondWhatUDidIsNoExplanation) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        Record record = simulate(even_times(600, 1), 30, 60, {{60, 32}}, first_order(2, 20, 5));
        add_noise(record, 0.02, seed);
        Record scatter = record;
        scatter.y = record.u;
        add_noise(scatter, 0.08, seed + 100);
        record.u = scatter.y;  // as read back
        const auto model = identify(record, {}, {});
        ASSERT_TRUE(model);
        EXPECT_NEAR(static_gain(*model), 2, 0.1) << seed;
        EXPECT_FALSE(warned(*model, "load-disturbance")) << seed;
    }
}

/// A relay of +-1 that samples y = 2 e^(-5s)/(20s + 1) every half second, from rest, recorded every `rows` seconds.
Record coarse_relay_record(double hysteresis, double rows) {
    constexpr double kLook = 0.5;
    constexpr int kDelay = 10, kMaxCancelTries = 1000, kStart = 60;
    const double decay = std::exp(-kLook / 20);
    std::vector<double> u(kMaxCancelTries, 0.0);
    Record record;
    double y = 0, level = 1;
    const int every = static_cast<int>(std::lround(rows / kLook));
    for (int k = 0; k < kMaxCancelTries; ++k) {
        if (k >= kStart) {
            if (y > hysteresis) level = -1;
            if (y < -hysteresis) level = 1;
            u[static_cast<std::size_t>(k)] = level;
        }
        if (k % every == 0) {
            record.t.push_back(k * kLook);
            record.u.push_back(40 + 10 * u[static_cast<std::size_t>(k)]);
            record.y.push_back(70 + y);
        }
        y = decay * y + 2 * (1 - decay) * (k >= kDelay ? u[static_cast<std::size_t>(k - kDelay)] : 0);
    }
    add_noise(record, 0.002, 5);
    return record;
}

TEST(Records, ARelayThatSwitchesBetweenRowsGivesADesignThatHolds) {
    const LinearPlant truth = *LinearPlant::make(Fopdt{.K = 0.2, .T = 20, .L = 5});
    for (const double hysteresis : {0.07, 0.08, 0.1}) {
        const auto model = identify(coarse_relay_record(hysteresis, 2), {}, {});
        ASSERT_TRUE(model) << model.error().message;
        // The times of the switches are estimated, and their uncertainty is included, or the answer warns that it is
        // not.
        const bool counted = std::ranges::any_of(model->data_quality.notes, [](const std::string& note) {
            return note.find("the standard errors include this") != std::string::npos;
        });
        EXPECT_TRUE(counted || warned(*model, "coarse-relay-record")) << hysteresis;
        TuningRequest request;
        request.subject = std::get<AnalysedPlant>(AnalysedPlant::make(model->plant));
        request.tune = {{.method = "robust", .options = {}}};
        const auto tuned = tune(request, {});
        ASSERT_TRUE(tuned);
        const auto judged =
            evaluate(Fopdt{.K = 0.2, .T = 20, .L = 5}, tuned->controllers[0].evaluation->controller, {});
        ASSERT_TRUE(judged);
        ASSERT_TRUE(judged->robustness.stable) << hysteresis;
        EXPECT_LT(*judged->robustness.Ms, 1.75) << hysteresis;
    }
}

TEST(Records, WhatOnlyASlowPartExplainsIsNotExplainedAway) {
    // The record ends in the inverse response of a plant with opposite sign: gain 5, b = -6, lags 9 and 4.
    const auto inverse = [](double t) {
        if (t <= 0) return 0.0;
        const double by_nine = (9 + 6) / (9.0 - 4), by_four = (4 + 6) / (9.0 - 4);
        return 5 * (1 - by_nine * std::exp(-t / 9) + by_four * std::exp(-t / 4));
    };
    Record record = simulate(even_times(140, 0.1), 0, 0, {{2, 1}}, inverse);
    add_noise(record, 0.005, 4);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    const double K = static_gain(*model), std = model->standard_errors.at("K");
    EXPECT_TRUE(std::abs(K - 5) <= 0.1 * 5 || std::abs(K - 5) <= 3 * std) << K << " +- " << std;
}

TEST(Records, TheDefaultDesignHoldsOnStructuresThatTheRecordDoesNotTellApart) {
    TuningRequest request;
    EvaluateOptions options;
    options.points = 0;
    int open = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        Record record = simulate(even_times(150, 1), 0, 0, {{20, 1}}, two_lags(1, 14, 7, 2));
        add_noise(record, 0.04, seed);
        request.record = record;
        const auto result = tune(request, {});
        ASSERT_TRUE(result);
        for (const Plant& other : result->model->alternatives) {
            const auto there = evaluate(PlantModel(other), result->controllers.front().evaluation->controller, options);
            ASSERT_TRUE(there);
            EXPECT_LE(there->robustness.Ms.value_or(99), 1.4 * 1.02) << seed;
            ++open;
        }
    }
    EXPECT_GE(open, 4);
}

TEST(Records, FalseReadingsBesideAStepAreNamedAndLeftOut) {
    Record record = simulate(even_times(300, 0.02), 0, 0, {{2, 255}}, first_order(0.0445, 0.057, 0));
    add_noise(record, 0.05, 5);
    record.y[101] = 16, record.y[102] = 16.7;
    for (int i = 0; i < 300; ++i) record.line.push_back(i + 2);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    const auto& plant = std::get<Fopdt>(model->plant);
    EXPECT_NEAR(plant.T, 0.057, 0.003);
    const auto removed = std::ranges::find(model->warnings, "removed-outliers", &Warning::code);
    ASSERT_NE(removed, model->warnings.end());
    EXPECT_THAT(removed->detail, HasSubstr("line 103 (t = 2.02), line 104 (t = 2.04)"));
}

TEST(Records, APulseThatTheProcessAnswersIsNoFalseReading) {
    Steps steps = {{20, 1}, {22, 0}, {60, 1}};
    Record record = simulate(even_times(400, 0.25), 0, 0, steps, first_order(2, 0.4, 0));
    add_noise(record, 0.01, 5);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    EXPECT_FALSE(model->data_quality.outliers);
}

/// u beyond 0 to 100 has no further effect.
Record beyond_its_ends() {
    const Steps asked = {{20, 60}, {80, 400}, {140, -300}, {200, 150}, {260, 30}};
    Steps reaching = asked;
    for (auto& [time, level] : reaching) level = std::clamp(level, 0.0, 100.0);
    Record record = simulate(even_times(700, 0.5), 40, 20, reaching, first_order(0.5, 15, 3));
    record.u = simulate(record.t, 40, 20, asked, first_order(0.5, 15, 3)).u;
    add_noise(record, 0.1, 9);
    return record;
}

TEST(InputLimits, AreTakenAsGivenOrFoundWherePlain) {
    Record record = beyond_its_ends();
    const auto found = identify(record, {}, {});
    ASSERT_TRUE(found && found->data_quality.u_limits);
    EXPECT_EQ((*found->data_quality.u_limits)[0], 0);
    EXPECT_EQ((*found->data_quality.u_limits)[1], 100);
    EXPECT_NEAR(static_gain(*found), 0.5, 0.01);
    EXPECT_TRUE(noted(*found, "logged before its limiter"));
    record.u_limits = {0, 100};
    const auto given = identify(record, {}, {});
    ASSERT_TRUE(given);
    EXPECT_EQ(static_gain(*given), static_gain(*found));
    EXPECT_FALSE(noted(*given, "logged before its limiter"));
}

TEST(InputLimits, AreNotFoundWhereUReachesThePlantWhole) {
    Record record =
        simulate(even_times(700, 0.5), 40, 20, {{20, 60}, {80, 400}, {140, -300}, {200, 150}}, first_order(0.5, 15, 3));
    add_noise(record, 0.1, 9);
    const auto model = identify(record, {}, {});
    ASSERT_TRUE(model);
    EXPECT_FALSE(model->data_quality.u_limits);
    EXPECT_NEAR(static_gain(*model), 0.5, 0.005);
}

TEST(Response, ThirdOrderIsTheSumOfItsExponentials) {
    // Lags 0.05, 0.11, 0.3 of a record of length 1.
    const double T3 = 0.05, Ta = 0.11, Tb = 0.3;
    const ModelShape shape{Structure::third,
                           {0.02, std::log(Ta + Tb), std::log(Ta * Tb / ((Ta + Tb) * (Ta + Tb))), 0, std::log(T3)}};
    std::vector<double> t;
    for (int i = 0; i < 50; ++i) t.push_back(i / 50.0 + 0.003 * std::sin(i));
    std::sort(t.begin(), t.end());
    static constexpr double kAt[] = {0.1}, kUnit[] = {1};
    UnitResponse got;
    unit_response(t, {kAt, kUnit}, shape, 2, got);
    const auto wanted = lags(1, {T3, Ta, Tb});
    for (std::size_t i = 0; i < t.size(); ++i) {
        EXPECT_NEAR(got.x[i], wanted(t[i] - 0.12), 1e-12);
        constexpr double h = 1e-5;
        if (std::abs(t[i] - 0.12) > 2 * h) {
            EXPECT_NEAR(got.x1[i], (wanted(t[i] - 0.12 + h) - wanted(t[i] - 0.12 - h)) / (2 * h), 1e-6);
        }
    }
}

TEST(Response, AnIntegratorOfTwoLagsIsTheIntegralOfTheirResponse) {
    const double Ta = 0.05, Tb = 0.2;
    const ModelShape shape{Structure::ipdt_second,
                           {0, std::log(Ta + Tb), std::log(Ta * Tb / ((Ta + Tb) * (Ta + Tb))), 0, 0}};
    static constexpr double kAt[] = {0}, kUnit[] = {1};
    const std::vector<double> t = {0.01, 0.3, 0.31, 1};
    UnitResponse got;
    unit_response(t, {kAt, kUnit}, shape, 1, got);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double ramp =
            t[i] - Ta - Tb + (Ta * Ta * std::exp(-t[i] / Ta) - Tb * Tb * std::exp(-t[i] / Tb)) / (Ta - Tb);
        EXPECT_NEAR(got.x[i], ramp, 1e-13);
        EXPECT_NEAR(got.x1[i], lags(1, {Ta, Tb})(t[i]), 1e-13);
    }
}

TEST(ResidualNoise, KnowsTheLongRunVarianceOfSlowNoise) {
    // First order: sigma^2 (1 + a)/(1 - a) for unit variance.
    for (const double pole : {0.0, 0.8, 0.95}) {
        double sum = 0;
        for (unsigned seed = 1; seed <= 40; ++seed) {
            Record record;
            record.y.assign(2000, 0.0);
            add_noise(record, 1, seed, pole);
            sum += ResidualNoise(record.y, 0, 0).long_run_variance() / 40;
        }
        const double exact = (1 + pole) / (1 - pole);
        EXPECT_GT(sum, 0.9 * exact) << pole;
        EXPECT_LT(sum, 1.3 * exact) << pole;  // means over blocks overestimate the variance of a slow process
    }
    EXPECT_NEAR(student_factor(10), 2.228139 / 1.959964, 2e-3);  // Abramowitz and Stegun 1964, table 26.10
}

TEST(DefaultDesign, HoldsItsLimitWhereTheModelAloneDoesNot) {
    Record record = simulate(even_times(200, 0.5), 0, 0, {{15, 1}}, first_order(2, 10, 1.2));
    add_noise(record, 0.15, 4);
    TuningRequest request;
    request.record = record;
    request.evaluate.points = 0;
    const auto both = tune(request, {});
    ASSERT_TRUE(both);
    ASSERT_EQ(both->controllers.size(), 2U);
    EXPECT_TRUE(both->controllers[0].over_region);
    EXPECT_EQ(both->ranking.front(), 0);
    EXPECT_LE(*both->controllers[0].evaluation->region->worst_Ms, 1.4 * (1 + 1e-4));
    EXPECT_EQ(both->controllers[0].evaluation->warnings.front().code, "held-on-region");
    EXPECT_FALSE(both->controllers[1].over_region);
    request.identified_region = IdentifiedRegion::unused;
    const auto alone = tune(request, {});
    ASSERT_TRUE(alone);
    ASSERT_EQ(alone->controllers.size(), 1U);
    EXPECT_FALSE(alone->controllers[0].over_region);
}

}  // namespace
}  // namespace tunewright
