// Settings typed into a product, today's or those of the user's choice: their loop, and their ideal form.
#include <gtest/gtest.h>

#include "tests/engine/request/expect_device.h"

namespace tunewright {
namespace {

using namespace test;
using product::Settings;

const Case kPlant{"two lags", Sopdt{.K = 2, .T1 = 10, .T2 = 4, .L = 3}, 3, {0, 400, 4, 20}};

// Settings near Kp = 0.7, Ti = 9 s, Td = 2.5 s; the other settings have the maker's defaults.
Settings settings_of(const std::string& product, double Ts) {
    if (product == "siemens_pid_compact") return {{"Gain", 0.7}, {"Ti", 9.0}, {"Td", 2.5}, {"TdFiltRatio", 0.2}};
    if (product == "rockwell_pide_independent") return {{"PGain", 17.5}, {"IGain", 116.7}, {"DGain", 0.729}};
    if (product == "rockwell_pid_dependent") return {{"KP", 17.5}, {"KI", 0.15}, {"KD", 0.0417}};
    if (product == "emerson_deltav_series") return {{"GAIN", 11.0}, {"RESET", 6.0}, {"RATE", 3.2}};
    if (product == "mitsubishi_fx_pid")
        return {{"KP", 1750.0}, {"TI", 90.0}, {"TD", 250.0}, {"KD", 10.0}, {"TS", 1000 * Ts}};
    if (product == "omron_pid190")
        return {{"P", 57.0}, {"Tik_0_1s", 90.0}, {"Tdk_0_1s", 25.0}, {"alpha_code", std::string("135")}};
    if (product == "controlsystems_jl_pid") return {{"param_p", 0.7}, {"param_i", 9.0}, {"param_d", 2.5}, {"Tf", 0.4}};
    if (product == "marlin") return {{"P", 11.16}, {"I", 1.24}, {"D", 27.9}, {"PID_K1", 0.7}};
    if (product == "klipper") return {{"pid_Kp", 11.16}, {"pid_Ki", 1.24}, {"pid_Kd", 27.9}, {"smooth_time", 0.8}};
    if (product == "reprapfirmware") return {{"P", 11.16}, {"I", 1.24}, {"D", 27.9}};
    if (product == "esphome_pid") return {{"kp", 0.0437}, {"ki", 0.00486}, {"kd", 0.109}};
    if (product == "discretepids_jl") return {{"K", 0.7}, {"Ti", 9.0}, {"Td", 2.5}, {"Ts", Ts}};
    if (product == "openplc_iec_pid") return {{"KP", -0.7}, {"TR", 9.0}, {"TD", 2.5}, {"CYCLE_s", Ts}};
    if (product == "matlab_pidstd") return {{"Kp", 0.7}, {"Ti", 9.0}, {"Td", 2.5}, {"N", 5.0}};
    return {{"Kc", 0.7}, {"Ti_min", 0.15}, {"Td_min", 0.0417}};  // LabVIEW
}

TuningRequest request_with_baseline(const std::string& product, const Settings& settings, double Ts) {
    TuningRequest request = request_of(kPlant, "simc");
    const device::DeviceModel device = device_of(product, kPlant, Ts);
    const auto typed = typed_controller(device, settings);
    EXPECT_TRUE(typed) << product;
    request.baseline = *typed;
    request.controllers = {*typed};
    return request;
}

class DeviceBaseline : public testing::TestWithParam<std::string> {};

// The longer sample time shows the effect of the rules of integral, derivative and filter.
TEST_P(DeviceBaseline, IsJudgedAsTheProductsOwnProgramRunsIt) {
    for (const double Ts : {0.1, 0.5}) {
        const auto result = tune(request_with_baseline(GetParam(), settings_of(GetParam(), Ts), Ts), {});
        ASSERT_TRUE(result);
        ASSERT_EQ(result->controllers.size(), 3U);
        for (const std::size_t index : {1U, 2U}) {
            const TuningEntry& entry = result->controllers[index];
            ASSERT_EQ(entry.method, index == 1 ? "given" : "baseline");
            ASSERT_TRUE(entry.on_device) << (entry.error ? entry.error->message
                                                         : entry.evaluation->warnings.back().detail);
            ASSERT_TRUE(std::isfinite(entry.on_device->loop.performance.load.IAE.value_or(INFINITY)));
            expect_figures_of_own_program(*entry.on_device, GetParam(), kPlant);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Products, DeviceBaseline,
                         testing::Values("siemens_pid_compact", "rockwell_pide_independent", "rockwell_pid_dependent",
                                         "emerson_deltav_series", "mitsubishi_fx_pid", "omron_pid190",
                                         "controlsystems_jl_pid", "marlin", "klipper", "reprapfirmware", "esphome_pid",
                                         "discretepids_jl", "openplc_iec_pid", "matlab_pidstd", "labview_pid"),
                         name_of_case);

// TS is a whole number of milliseconds, and the block computes with it whatever was requested.
TEST(DevicePeriod, IsTheOneThatIsTyped) {
    const Case fast{"fast", Fopdt{.K = 2, .T = 0.2, .L = 0.05}, 0.05, {0, 10, -10, 10}};
    TuningRequest request = request_of(fast, "simc");
    request.device = device_of("mitsubishi_fx_pid", fast, 0.0004);
    const auto result = tune(request, {});
    ASSERT_TRUE(result && result->controllers.front().on_device);
    const DeviceEntry& on_device = *result->controllers.front().on_device;
    EXPECT_EQ(typed_of(on_device.fitted, fast, 0.001).text.at("TS"), "1");
    EXPECT_DOUBLE_EQ(on_device.fitted.law.Ts, 0.001);
    expect_figures_of_own_program(on_device, "mitsubishi_fx_pid", fast);
}

}  // namespace
}  // namespace tunewright
