// The figures of a product, compared with a program written from the maker's equations, with settings typed from the
// answer's texts, on a plant that shares no code with the engine.
#include <gtest/gtest.h>

#include "tests/engine/request/expect_device.h"
#include "tests/long_or_quick.h"

namespace tunewright {
namespace {

using namespace test;

// A long run checks every sixth pair of product and plant, so that each plant occurs with every family of laws; with
// all pairs the figures hold too.
const std::size_t kEvery = static_cast<std::size_t>(long_or_quick(6, 18));

std::size_t number_of(const std::string& product) {
    const auto& all = read_products();
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), product) - all.begin());
}

std::vector<Case> some_plants(const std::string& product, std::size_t every, std::size_t from = 0) {
    std::vector<Case> some;
    const auto& all = device_plants();
    for (std::size_t i = 0; i < all.size(); ++i)
        if ((i + number_of(product) + from) % every == 0) some.push_back(all[i]);
    return some;
}

class DeviceFigures : public testing::TestWithParam<std::string> {};

TEST_P(DeviceFigures, AreThoseOfTheProductsOwnProgramAsItIsTyped) {
    const std::string product = GetParam();
    const char* const methods[] = {"robust", "simc", "robust", "amigo"};
    std::size_t n = number_of(product);
    for (const Case& c : some_plants(product, kEvery)) {
        TuningRequest request = request_of(c, methods[n++ % 4]);
        request.device = device_of(product, c, c.shortest / 100);
        const auto result = tune(request, {});
        if (!result) {
            expect_sentence(result.error().message);
            continue;
        }
        const TuningEntry& entry = result->controllers.front();
        ASSERT_TRUE(entry.evaluation);
        if (entry.on_device) {
            expect_figures_of_own_program(*entry.on_device, product, c);
            continue;
        }
        const auto& warnings = entry.evaluation->warnings;
        const auto why = std::find_if(warnings.begin(), warnings.end(),
                                      [](const Warning& warning) { return warning.code == "not-as-built"; });
        ASSERT_NE(why, warnings.end()) << product << " on " << c.name;
        expect_sentence(why->detail);
    }
}

INSTANTIATE_TEST_SUITE_P(Products, DeviceFigures, testing::ValuesIn(read_products()), name_of_case);

class DeviceDesigns : public testing::TestWithParam<std::string> {};

TEST_P(DeviceDesigns, HoldTheirLimitsOnTheOwnProgramAsItIsTyped) {
    const std::string product = GetParam();
    for (const Case& c : some_plants(product, 7, 3)) {
        TuningRequest request = request_of(c, "robust");
        request.device = device_of(product, c, c.shortest / 40);
        const auto result = tune(request, {});
        ASSERT_TRUE(result) << product << " on " << c.name << ": " << result.error().message;
        const TuningEntry& entry = result->controllers.front();
        ASSERT_TRUE(entry.on_device && entry.Ms_limit);
        const double Ts = entry.on_device->fitted.law.Ts;
        const Typed typed = typed_of(entry.on_device->fitted, c, Ts);
        const OwnPeaks peaks = own_peaks(OwnLoopPlant(c.plant, Ts, 0), own_program(product, typed), Ts);
        EXPECT_LE(peaks.Ms, *entry.Ms_limit * (1 + 1e-4)) << product << " on " << c.name;
        EXPECT_LE(peaks.Mt, *entry.options.number("Mt") * (1 + 1e-4)) << product << " on " << c.name;
    }
}

// One product of each family of laws.
INSTANTIATE_TEST_SUITE_P(Products, DeviceDesigns,
                         testing::Values("siemens_pid_compact", "rockwell_pide_independent", "emerson_deltav_series",
                                         "mitsubishi_fx_pid", "openplc_iec_pid", "matlab_pid", "reprapfirmware",
                                         "controlsystems_jl_pid"),
                         name_of_case);

// A heater's gain is never negative, and none of its settings reverses it.
TEST(DeviceRefusals, SayThatAHeaterCannotActTheOtherWay) {
    for (const std::string product : {"marlin", "klipper", "esphome_pid", "betaflight"}) {
        const Case& c = device_plants()[4];  // of negative gain
        TuningRequest request = request_of(c, "robust");
        request.device = device_of(product, c, c.shortest / 20);
        const auto result = tune(request, {});
        ASSERT_FALSE(result) << product;
        EXPECT_NE(result.error().message.find("its gain cannot be negative"), std::string::npos)
            << result.error().message;
    }
}

TEST(DeviceRefusals, SayThatProportionalActionAloneIsNoDesign) {
    const Case& c = device_plants()[0];
    TuningRequest request = request_of(c, "robust");
    request.device = device_of("ha_versatile_thermostat_tpi", c, c.shortest / 20);
    const auto result = tune(request, {});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("only proportional action"), std::string::npos) << result.error().message;
}

}  // namespace
}  // namespace tunewright
