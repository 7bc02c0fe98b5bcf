// Products whose filter is a number of samples, on plants that are resonant or mostly dead time: their designs compared
// with brute force for that number. A sample of the plants; all 60 with TUNEWRIGHT_ALL_PLANTS=1.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/engine/request/brute_force.h"
#include "tests/engine/request/expect_device.h"

namespace tunewright {
namespace {

using namespace test;

constexpr int kPlants = 60;

struct Task {
    Case plant;
    double Ts = 0, M = 1.4;  ///< limits of Ms and Mt
};

/// Each from its own seed, so that a part of them is the same as in the whole set.
Task task_of(int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto log_uniform = [&](double low, double high) {
        return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(random));
    };
    const double K = log_uniform(0.2, 200), T = log_uniform(5, 100);
    Task task{.plant = {.name = "seed " + std::to_string(seed), .plant = {}, .shortest = T, .spans = {0, 100, 0, 1}}};
    if (seed % 2 == 0) {
        const double L = T * log_uniform(0.05, 2);
        task.plant.plant = OscillatorySopdt{.K = K, .T = T, .zeta = log_uniform(0.08, 0.7), .L = L};
        task.Ts = std::min(T, L) / log_uniform(3, 12);
    } else {
        const double L = T * log_uniform(0.7, 10);
        task.plant.plant = Fopdt{.K = K, .T = T, .L = L};
        task.Ts = L / log_uniform(4, 15);
    }
    task.M = seed % 3 == 0 ? 1.4 : seed % 3 == 1 ? 1.7 : 2;
    return task;
}

std::vector<int> seeds() {
    if (std::getenv("TUNEWRIGHT_ALL_PLANTS") == nullptr) return {4, 17, 38};
    std::vector<int> all;
    for (int seed = 0; seed < kPlants; ++seed) all.push_back(seed);
    return all;
}

/// The cost relative to the best by brute force.
double cost_against_trying(const std::string& product, const Task& task) {
    TuningRequest request = request_of(task.plant, "robust");
    request.tune[0].options.set("Ms", task.M);
    request.tune[0].options.set("Mt", task.M);
    request.device = device_of(product, task.plant, task.Ts);
    const auto result = tune(request, {});
    if (!result) {
        ADD_FAILURE() << product << " on " << task.plant.name << ": " << result.error().message;
        return 0;
    }
    const DeviceEntry& on_device = *result->controllers.front().on_device;
    const Typed typed = typed_of(on_device.fitted, task.plant, on_device.fitted.law.Ts);
    BruteForce brute(product, form_of(product, task.plant), typed,
                     Judge(task.plant, on_device.fitted.law.Ts, task.M, task.M));
    if (product == "klipper" && typed.number("pid_Kd") > 0) {
        const double Td = typed.number("pid_Kd") / typed.number("pid_Kp");
        brute.tie = [=, ratio = (typed.number("smooth_time") - typed.Ts) / Td](Typed& t) {
            t.text["smooth_time"] = four_digits(typed.Ts + ratio * t.number("pid_Kd") / t.number("pid_Kp"));
        };
    }
    const auto best = brute.best(kNet, kRounds);
    const double times = *on_device.loop.performance.load.IAE / best.IAE;
    EXPECT_LE(times, kWorse) << product << " on " << task.plant.name << " with " << words_of(typed) << ": better is"
                             << words_of(best.typed);
    return times;
}

class DeviceSamples : public testing::TestWithParam<std::string> {};

TEST_P(DeviceSamples, LeaveNothingToTrying) {
    double worst = 0;
    for (const int seed : seeds()) worst = std::max(worst, cost_against_trying(GetParam(), task_of(seed)));
    RecordProperty("worst", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Products, DeviceSamples,
                         testing::Values("esphome_pid", "reprapfirmware", "openplc_iec_pid", "klipper", "marlin"),
                         name_of_case);

// A resonance with dead time, where the optimum has complex zeros: Ti far below Td. Found by brute force over all four
// numbers of ESPHome: kp 0.000943, ki 0.0000825, kd 0.2 and two samples have 13,436 (Ms 1.990).
TEST(DeviceSamples, TheBestOfAResonanceLiesFarFromTheIdealDesign) {
    const Task task{.plant = {.name = "resonance",
                              .plant = OscillatorySopdt{.K = 134, .T = 36.2, .zeta = 0.161, .L = 22.5},
                              .shortest = 22.5,
                              .spans = {0, 100, 0, 1}},
                    .Ts = 4.5,
                    .M = 2};
    TuningRequest request = request_of(task.plant, "robust");
    request.tune[0].options.set("Ms", task.M);
    request.tune[0].options.set("Mt", task.M);
    request.device = device_of("esphome_pid", task.plant, task.Ts);
    const auto result = tune(request, {});
    ASSERT_TRUE(result) << result.error().message;
    const DeviceLoop& loop = result->controllers.front().on_device->loop;
    EXPECT_LE(*loop.performance.load.IAE, 1.001 * 13436);
    EXPECT_LE(*loop.robustness.Ms, 2 * (1 + 1e-6));
}

}  // namespace
}  // namespace tunewright
