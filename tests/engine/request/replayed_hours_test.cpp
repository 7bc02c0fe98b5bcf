// Simulated hours with unmeasured disturbances: how often the ratio of the replay is right, and how often its band
// holds the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/identification/closed_loop/loop_record.h"
#include "engine/request/replay/replay.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

using test::Random;

/// A plant of two lags and a dead time, a PI, and what moves them, ten steps a row.
struct HourOfLoop {
    static constexpr int kRows = 900, kSteps = 10;
    double K, T1, T2, L, h;
    std::vector<double> r = std::vector<double>(kRows, 0.0);
    std::vector<double> load = std::vector<double>(kRows * kSteps, 0.0), output = load;
    std::vector<double> noise = std::vector<double>(kRows, 0.0);

    LoopRows run(double Kp, double Ti) const {
        LoopRows rows{.t0 = 0, .h = h, .u = {}, .y = {}, .r = r};
        const double dt = h / kSteps, a1 = std::exp(-dt / T1), a2 = std::exp(-dt / T2);
        const auto late = static_cast<std::size_t>(std::lround(L / dt));
        std::vector<double> given;
        double x1 = 0, x2 = 0, integral = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(kRows); ++k) {
            const double y = x2 + output[k * kSteps] + noise[k], e = r[k] - y;
            integral += Kp / Ti * h * e;
            rows.y.push_back(y);
            rows.u.push_back(Kp * e + integral);
            for (std::size_t j = k * kSteps; j < (k + 1) * kSteps; ++j) {
                given.push_back(rows.u.back());
                const double before = x1;
                x1 = a1 * x1 + (1 - a1) * K * ((j >= late ? given[j - late] : 0) + load[j]);
                x2 = a2 * x2 + (1 - a2) * 0.5 * (before + x1);
            }
        }
        return rows;
    }
};

HourOfLoop random_hour(Random& random) {
    HourOfLoop hour{.K = random.log_uniform(0.3, 3), .T1 = random.log_uniform(30, 200), .T2 = 0, .L = 0, .h = 0};
    hour.T2 = hour.T1 * random.uniform(0.05, 0.5);
    hour.L = hour.T1 * random.log_uniform(0.15, 1);
    hour.h = 0.1 * (hour.L + 0.3 * hour.T1);
    const int rows = HourOfLoop::kRows, steps = rows * HourOfLoop::kSteps;
    for (int move = 0; move < 3; ++move) {
        const int from = static_cast<int>(rows * random.uniform(0.03, 0.9));
        const double size = random.uniform(-1, 1);
        for (int k = from; k < rows; ++k) hour.r[static_cast<std::size_t>(k)] += size;
    }
    const double level = random.log_uniform(0.05, 0.8), period = steps * random.log_uniform(0.01, 0.3);
    const int at = static_cast<int>(steps * random.uniform(0, 0.9)), ramp = steps / 10;
    double walk = 0;
    for (int j = 0; j < steps; ++j) {
        walk = 0.998 * walk + 0.063 * random.uniform(-1.7, 1.7);
        const auto step = static_cast<std::size_t>(j);
        hour.load[step] = level / hour.K * std::clamp((j - at) / static_cast<double>(ramp), 0.0, 1.0);
        hour.output[step] = 0.2 * level * (std::min(1.0, j / 100.0) * walk + std::sin(6.28 * j / period));
    }
    const double noise = random.log_uniform(0.001, 0.02);
    for (double& value : hour.noise) value = noise * random.uniform(-1.7, 1.7);
    return hour;
}

/// A lag and a dead time by the half rule, wrong by the standard errors that it states.
IdentifiedModel inexact_model(const HourOfLoop& hour, Random& random) {
    const double T = hour.T1 + hour.T2 / 2, L = hour.L + hour.T2 / 2;
    const double eK = random.log_uniform(0.01, 0.1), eT = random.log_uniform(0.02, 0.15),
                 eL = random.log_uniform(0.02, 0.12);
    const auto normal = [&] {
        double sum = 0;
        for (int i = 0; i < 12; ++i) sum += random.uniform(-0.5, 0.5);
        return sum;
    };
    IdentifiedModel model;
    model.plant = Fopdt{.K = hour.K * (1 + eK * normal()), .T = T * (1 + eT * normal()), .L = L * (1 + eL * normal())};
    model.fit_percent = 90;
    model.covariance.names = {"K", "T", "L"};
    const double K = eK * hour.K;
    model.covariance.matrix = {{K * K, 0, 0}, {0, eT * eT * T * T, 0}, {0, 0, eL * eL * L * L}};
    model.data_quality.closed_loop.emplace().used = LoopExcitation::set_point;
    return model;
}

double IAE_of(const LoopRows& rows) { return replay_figures(rows.h, rows.r, rows.y, rows.u, 0).IAE; }

// Required: within 15 % for nine of ten hours, in the band for nine of ten.
TEST(ReplayedHours, AreRightWithin15PercentAndWithinTheirBands) {
    Random random(51);
    int answered = 0, near = 0, held = 0, apart = 0;
    constexpr int kHours = 200;
    for (int i = 0; i < kHours; ++i) {
        const HourOfLoop hour = random_hour(random);
        const double L = hour.L + hour.T2 / 2, T = hour.T1 + hour.T2 / 2;
        const auto gain = [&](double slower) { return T / (hour.K * (1 + slower) * L); };
        const auto reset = [&](double slower) { return std::min(T, 4 * (1 + slower) * L); };
        const double today = random.log_uniform(0.9, 6), other = random.log_uniform(0.8, 4);
        const LoopRows record = hour.run(gain(today), reset(today));
        const double truth = IAE_of(hour.run(gain(other), reset(other))) / IAE_of(record);
        TuningRequest request;
        Record& sent = request.record.emplace();
        sent.u = record.u;
        sent.y = record.y;
        sent.r = record.r;
        for (std::size_t k = 0; k < record.size(); ++k) sent.t.push_back(hour.h * static_cast<double>(k));
        request.evaluate.points = 0;
        TuningEntry entry;
        entry.evaluation.emplace();
        entry.evaluation->controller = IdealPid{.Kp = gain(other), .Ti = reset(other)};
        IdentifiedModel model = inexact_model(hour, random);
        const CleanRecord clean = *clean_record(sent);
        model.loop = std::make_shared<const IdentifiedLoop>(identified_loop(clean, set_point_of(clean, sent), sent));
        const auto replay = RecordReplayer(request, model).of(entry);
        if (!replay || replay->refused) continue;
        ++answered;
        near += std::abs(replay->IAE_ratio / truth - 1) <= 0.15;
        held += replay->IAE_ratio_low <= truth && truth <= replay->IAE_ratio_high;
        apart += std::abs(truth - 1) > 0.15;
    }
    EXPECT_GE(answered, 0.8 * kHours);
    EXPECT_GE(near, 0.9 * answered);
    EXPECT_GE(held, 0.9 * answered);
    EXPECT_GE(apart, 0.3 * answered);  // a ratio of 1 for all would not pass
}

}  // namespace
}  // namespace tunewright
