// Settings that stop the cycle of a sticking valve: tried on the loop that made the record, with its own valve and
// plant.
#include "engine/check/valve/cycle_stops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/engine/check/simulated_loop.h"

namespace tunewright::check {
namespace {

constexpr double kNoIntegral = std::numeric_limits<double>::infinity();

struct Settings {
    double Kp = 0, Ti = 0, gap = 0;
};

/// The loop of simulated(), in deviations, without noise and with settings that change.
class TrueLoop {
public:
    TrueLoop(const LoopSetUp& s, const Settings& settings, bool good_valve)
        : s_(s),
          settings_(settings),
          valve_(s.band, s.jump, 0),
          good_(good_valve),
          held_(std::size_t(std::lround(s.plant.L)) + 1, 0.0) {}

    void take(const Settings& settings) {
        settings_ = settings;
        integral_ = u + settings.Kp * y;
    }
    void run(int rows, double load) {
        for (int i = 0; i < rows; ++i) {
            const double a = std::exp(-1 / s_.plant.T);
            held_[row_ % held_.size()] = (good_ ? u : valve_(u)) + load;
            y = a * y + (1 - a) * s_.plant.K * held_[(row_ + 1) % held_.size()];
            ++row_;
            if (std::abs(y) > settings_.gap) integral_ -= settings_.Kp * y / settings_.Ti;
            u = integral_ - settings_.Kp * y;
            travel_low = std::min(travel_low, u);
            travel_high = std::max(travel_high, u);
            sum += std::abs(y);
        }
    }
    double travel_of(int rows, double load) {
        travel_low = travel_high = u;
        run(rows, load);
        return travel_high - travel_low;
    }

    double y = 0, u = 0, sum = 0, travel_low = 0, travel_high = 0;

private:
    const LoopSetUp& s_;
    Settings settings_;
    StickingValve valve_;
    bool good_;
    std::vector<double> held_;
    std::size_t row_ = 0;
    double integral_ = 0;
};

/// True if the output comes to rest with these settings, begun anywhere in the cycle.
bool stops(const LoopSetUp& s, const Settings& today, const Settings& tried, double period) {
    const double slowest = std::max({period, s.plant.T, std::isfinite(tried.Ti) ? tried.Ti : 0});
    for (int phase = 0; phase < 5; ++phase) {
        TrueLoop loop(s, today, false);
        loop.run(3000 + int(phase * period / 5), s.bias);
        loop.take(tried);
        loop.run(int(20 * slowest), s.bias);
        if (loop.travel_of(int(10 * slowest), s.bias) > 0.02 * s.band) return false;
    }
    return true;
}

double error_after_load(const LoopSetUp& s, const Settings& settings, double period) {
    TrueLoop loop(s, settings, true);
    loop.run(int(kCostPeriods * period), s.band);
    return loop.sum;
}

LoopSetUp sticking_loop(test::Random& random) {
    LoopSetUp s;
    s.plant = {.K = random.uniform(0.5, 2.5), .T = random.log_uniform(6, 60), .L = std::round(random.uniform(2, 8))};
    s.slowness = random.uniform(1, 2);
    s.load = random.uniform(0.05, 0.2);
    s.noise = s.plant.K * random.uniform(0.02, 0.08);
    s.bias = random.uniform(1, 4) * (random.one_in(2) ? 1 : -1);
    s.y_grid = 0.005;
    s.band = random.uniform(2, 8);
    s.jump = s.band * random.uniform(0.2, 1);
    const double tau = s.slowness * s.plant.L;
    s.Kp = s.plant.T / (s.plant.K * (tau + s.plant.L));
    s.Ti = std::min(s.plant.T, 4 * (tau + s.plant.L));
    return s;
}

struct Answered {
    LoopCheck check;
    CycleStops stops;
};

/// Empty if the check does not find the valve.
std::optional<Answered> answered(const LoopSetUp& s, std::uint64_t seed, LoopKind kind = LoopKind::unknown) {
    LoopQuestion question;
    question.record = simulated(s, seed);
    question.u_range = {{0, 100}};
    question.kind = kind;
    auto check = check_loop(question, {});
    if (!check || check->action.code != ActionCode::repair_valve) return std::nullopt;
    CycleStops stops = cycle_stops(question, *check, {});
    return Answered{std::move(*check), std::move(stops)};
}

TEST(CycleStops, OfferedSettingsStopTheCycleOfTheLoopThatMadeTheRecord) {
    int loops = 0, with_offer = 0, offered = 0, stopped = 0, costed = 0;
    for (std::uint64_t seed = 700; seed < 740; ++seed) {
        test::Random random(seed);
        const LoopSetUp s = sticking_loop(random);
        const auto answer = answered(s, seed);
        if (!answer || !answer->check.cause.period) continue;
        ++loops;
        with_offer += answer->stops.stops.empty() ? 0 : 1;
        EXPECT_EQ(answer->stops.stops.empty(), answer->stops.outcome != CycleStops::Outcome::found);
        EXPECT_FALSE(answer->stops.detail.empty());
        const double period = *answer->check.cause.period;
        const Settings today{s.Kp, s.Ti, 0};
        for (const CycleStop& stop : answer->stops.stops) {
            const Settings tried{stop.Kp, stop.Ti.value_or(kNoIntegral), stop.gap};
            ++offered;
            stopped += stops(s, today, tried, period) ? 1 : 0;
            const double cost = error_after_load(s, tried, period) / error_after_load(s, today, period);
            EXPECT_LE(stop.error_ratio[0], stop.error_ratio[1]);
            costed += cost > 0.7 * stop.error_ratio[0] && cost < 1.3 * stop.error_ratio[1] ? 1 : 0;
        }
        if (!answer->stops.stops.empty()) {
            EXPECT_NEAR(*answer->stops.period / period, 1, 0.3);
            EXPECT_NEAR(*answer->stops.amplitude / answer->stops.recorded_amplitude, 1, 0.5);
        }
    }
    RecordProperty("offered", offered);
    RecordProperty("stopped", stopped);
    RecordProperty("costed", costed);
    EXPECT_GE(loops, 20);
    EXPECT_GE(with_offer, loops / 2);
    EXPECT_GE(stopped, offered * 8 / 10) << "of " << offered;
    EXPECT_GE(costed, offered * 8 / 10) << "of " << offered;
}

/// The position of a valve that sticks never is exactly that which the load of an integrating plant needs.
TEST(CycleStops, AnIntegratingPlantBehindAStickingValveIsOfferedNothing) {
    int loops = 0;
    for (std::uint64_t seed = 800; seed < 808; ++seed) {
        test::Random random(seed);
        LoopSetUp s = sticking_loop(random);
        s.plant.K *= 200;
        s.plant.T = 1e4;
        s.jump = s.band * random.uniform(0.4, 1);
        const double tau = s.slowness * s.plant.L;
        s.Kp = s.plant.T / (s.plant.K * (tau + s.plant.L));
        s.Ti = 4 * (tau + s.plant.L);
        const auto answer = answered(s, seed, LoopKind::level);
        if (!answer) continue;
        ++loops;
        EXPECT_TRUE(answer->stops.stops.empty()) << seed;
    }
    EXPECT_GE(loops, 4);
}

TEST(CycleStops, WithoutTodaysSettingsNothingIsTold) {
    test::Random random(700);
    const LoopSetUp s = sticking_loop(random);
    LoopQuestion question;
    question.record = simulated(s, 700);
    auto check = check_loop(question, {});
    ASSERT_TRUE(check);
    check->cause.size = s.band;
    check->cause.period = 40;
    check->law = {};
    const CycleStops stops = cycle_stops(question, *check, {});
    EXPECT_EQ(stops.outcome, CycleStops::Outcome::not_told);
    EXPECT_FALSE(stops.period);
    EXPECT_FALSE(stops.detail.empty());
}

}  // namespace
}  // namespace tunewright::check
