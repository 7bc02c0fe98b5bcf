// Settings of a product, compared with brute force on its own law and grid of numbers.
#include <gtest/gtest.h>

#include "tests/engine/request/brute_force.h"
#include "tests/engine/request/expect_device.h"

namespace tunewright {
namespace {

using namespace test;

BruteForce brute_force(const std::string& product, const Case& c, const device::Fitted& fitted, double Ms, double Mt) {
    const double Ts = fitted.law.Ts;
    const Typed typed = typed_of(fitted, c, Ts);
    BruteForce brute(product, form_of(product, c), typed, Judge(c, Ts, Ms, Mt));
    if (product == "klipper") {
        const double Td = typed.number("pid_Kd") / typed.number("pid_Kp");
        brute.tie = [=, ratio = (typed.number("smooth_time") - typed.Ts) / Td](Typed& t) {
            t.text["smooth_time"] = four_digits(typed.Ts + ratio * t.number("pid_Kd") / t.number("pid_Kp"));
        };
    }
    return brute;
}

class DeviceSearch : public testing::TestWithParam<std::string> {};

TEST_P(DeviceSearch, LeavesNothingToTrying) {
    const std::string product = GetParam();
    for (const std::size_t i : {0u, 3u, 6u, 8u, 11u, 12u, 15u, 17u, 18u, 19u}) {
        const Case& c = device_plants()[i];
        TuningRequest request = request_of(c, "robust");
        request.device = device_of(product, c, c.shortest / 20);
        const auto result = tune(request, {});
        ASSERT_TRUE(result) << product << " on " << c.name << ": " << result.error().message;
        const DeviceEntry& on_device = *result->controllers.front().on_device;
        const auto best = brute_force(product, c, on_device.fitted, 1.4, 1.4).best(kNet, kRounds);
        EXPECT_LE(*on_device.loop.performance.load.IAE, kWorse * best.IAE)
            << product << " on " << c.name << ": better is" << words_of(best.typed);
    }
}

INSTANTIATE_TEST_SUITE_P(Products, DeviceSearch,
                         testing::Values("siemens_pid_compact", "rockwell_pide_independent", "emerson_deltav_series",
                                         "klipper", "mitsubishi_fx_pid"),
                         name_of_case);

class NearestSettings : public testing::TestWithParam<std::string> {};

// The step rule of Ziegler and Nichols has Ti = 4 Td, which a series form with a filter of its lead cannot represent;
// Foxboro's lead has none and represents it exactly, but not AMIGO's shorter Ti.
TEST_P(NearestSettings, AreAsRobustAsTheIdealLoopAndLeaveNothingToTrying) {
    const std::string product = GetParam();
    const bool exact = product == "foxboro_pid";
    for (const std::size_t i : exact ? std::vector{4u, 5u, 6u} : std::vector{1u, 5u, 8u, 11u}) {
        const Case& c = device_plants()[i];
        TuningRequest request = request_of(c, exact ? "amigo" : "ziegler_nichols_step");
        request.device = device_of(product, c, c.shortest / 20);
        const auto result = tune(request, {});
        ASSERT_TRUE(result) << product << " on " << c.name << ": " << result.error().message;
        const TuningEntry& entry = result->controllers.front();
        ASSERT_TRUE(entry.on_device && entry.evaluation);
        const auto& notes = entry.on_device->fitted.notes;
        ASSERT_TRUE(!notes.empty() && notes.front().code == "nearest-settings") << product << " on " << c.name;
        expect_sentence(notes.front().detail);
        expect_figures_of_own_program(*entry.on_device, product, c);
        const Robustness &ideal = entry.evaluation->robustness, &real = entry.on_device->loop.robustness;
        EXPECT_LE(*real.Ms, *ideal.Ms * (1 + 1e-4)) << product << " on " << c.name;
        EXPECT_LE(*real.Mt, *ideal.Mt * (1 + 1e-4)) << product << " on " << c.name;
        const auto best = brute_force(product, c, entry.on_device->fitted, *ideal.Ms, *ideal.Mt).best(kNet, kRounds);
        EXPECT_LE(*entry.on_device->loop.performance.load.IAE, kWorse * best.IAE)
            << product << " on " << c.name << ": better is" << words_of(best.typed);
    }
}

TEST(ExactSettings, OfADoubleZeroNeedNothingNearest) {
    const Case& c = device_plants()[1];
    TuningRequest request = request_of(c, "ziegler_nichols_step");
    request.device = device_of("foxboro_pid", c, c.shortest / 100);
    const auto result = tune(request, {});
    ASSERT_TRUE(result && result->controllers.front().on_device);
    const DeviceEntry& on_device = *result->controllers.front().on_device;
    for (const product::Note& note : on_device.fitted.notes) EXPECT_NE(note.code, "nearest-settings");
    const Typed typed = typed_of(on_device.fitted, c, on_device.fitted.law.Ts);
    EXPECT_EQ(typed.text.at("INT"), typed.text.at("DERIV"));
    expect_figures_of_own_program(on_device, "foxboro_pid", c);
}

INSTANTIATE_TEST_SUITE_P(Products, NearestSettings,
                         testing::Values("emerson_deltav_series", "foxboro_pid", "honeywell_interactive_b"),
                         name_of_case);

}  // namespace
}  // namespace tunewright
