// Twenty plants and the thirty-three products whose equations were read, with a request for each pair.
#pragma once

#include <string>
#include <vector>

#include "engine/controller/product/catalogue.h"
#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"
#include "tests/engine/request/own_loop.h"

namespace tunewright::test {

struct Spans {
    double y_low = 0, y_high = 100, u_low = 0, u_high = 100;
};

struct Case {
    std::string name;
    Plant plant;
    double shortest = 1;  ///< shortest relevant time of the loop: lag, dead time
    Spans spans = {};
    double seconds = 1;  ///< seconds per unit of the plant's time
};

inline const std::vector<Case>& device_plants() {
    static const std::vector<Case> all = {
        {"lag 1 dead 0.1", Fopdt{.K = 1, .T = 1, .L = 0.1}, 0.1},
        {"lag 20 dead 1", Fopdt{.K = 0.8, .T = 20, .L = 1}, 1, {0, 200, 0, 100}},
        {"lag 1000 dead 60", Fopdt{.K = 3.5, .T = 1000, .L = 60}, 60, {-50, 450, 0, 100}},
        {"lag 0.05 dead 0.01", Fopdt{.K = 2, .T = 0.05, .L = 0.01}, 0.01, {0, 10, -10, 10}},
        {"balanced 2", Fopdt{.K = -1.5, .T = 2, .L = 2}, 2, {0, 100, 0, 100}},
        {"balanced 120", Fopdt{.K = 0.6, .T = 120, .L = 100}, 100, {20, 320, 0, 100}},
        {"dead time 5 lag 1", Fopdt{.K = 0.5, .T = 1, .L = 5}, 1, {0, 1, 0, 10}},
        {"dead time 300 lag 60", Fopdt{.K = -0.4, .T = 60, .L = 300}, 60, {0, 14, 0, 100}},
        {"two lags 10 4 dead 3", Sopdt{.K = 2, .T1 = 10, .T2 = 4, .L = 3}, 3, {0, 400, 4, 20}},
        {"two lags 500 80 dead 30", Sopdt{.K = 1.2, .T1 = 500, .T2 = 80, .L = 30}, 30, {0, 250, 0, 1}},
        {"two lags 0.5 0.05 dead 0.05", Sopdt{.K = -4, .T1 = 0.5, .T2 = 0.05, .L = 0.05}, 0.05, {-5, 5, 0, 255}},
        {"equal lags 30 dead 5", Sopdt{.K = 0.9, .T1 = 30, .T2 = 30, .L = 5}, 5, {0, 120, 0, 100}},
        {"integrator lag 3 dead 2", Ipdt{.K = 0.05, .L = 2, .T = 3}, 2, {0, 100, 0, 100}},
        {"integrator lag 50 dead 20", Ipdt{.K = -0.004, .L = 20, .T = 50}, 20, {0, 8, 0, 100}},
        {"integrator lag 0.1 dead 0.2", Ipdt{.K = 1.3, .L = 0.2, .T = 0.1}, 0.1, {-1, 1, -1, 1}},
        {"zero on the right 2", TransferFunction{.num = {-2, 1}, .den = {15, 8, 1}, .L = 0.5}, 0.5, {0, 50, 0, 100}},
        {"zero on the right 40", TransferFunction{.num = {40, -1}, .den = {6000, 160, 1}, .L = 0}, 40, {0, 50, 0, 100}},
        {"oscillating 4", OscillatorySopdt{.K = 1, .T = 4, .zeta = 0.3, .L = 1}, 1, {0, 60, 0, 100}},
        {"oscillating 0.2", OscillatorySopdt{.K = 0.7, .T = 0.2, .zeta = 0.5, .L = 0.1}, 0.1, {-3, 3, -12, 12}},
        {"minutes: lag 12 dead 2", Fopdt{.K = 1.1, .T = 12, .L = 2}, 2, {0, 150, 0, 100}, 60},
    };
    return all;
}

inline const std::vector<std::string>& read_products() {
    static const std::vector<std::string> all = {
        "siemens_pid_compact",
        "rockwell_pid_independent",
        "rockwell_pid_dependent",
        "rockwell_pide_independent",
        "rockwell_pide_dependent",
        "abb_knx_aba",
        "emerson_deltav_standard",
        "emerson_deltav_series",
        "yokogawa_ff_pid",
        "omron_pid190",
        "mitsubishi_fx_pid",
        "openplc_iec_pid",
        "oscat_ctrl_pid",
        "labview_pid",
        "matlab_pidstd",
        "matlab_pid",
        "simulink_pid_autotuner_block",
        "simple_pid",
        "arduino_pid_v1",
        "quickpid",
        "marlin",
        "klipper",
        "reprapfirmware",
        "esphome_pid",
        "ha_smart_thermostat",
        "ha_versatile_thermostat_tpi",
        "ardupilot_ac_pid",
        "px4_rate",
        "betaflight",
        "controlsystems_jl_pid",
        "discretepids_jl",
        "epics_epid",
        "ros_control_toolbox",
    };
    return all;
}

/// `Ts` in the plant's unit of time.
inline device::DeviceModel device_of(const std::string& product, const Case& c, double Ts) {
    device::DeviceModel device;
    device.product = product::find(product);
    device.context =
        product::Context::with_spans({c.spans.y_low, c.spans.y_high, c.spans.u_low, c.spans.u_high}, Ts * c.seconds);
    device.context.loop_clock_s = Ts * c.seconds;
    device.context.seconds_per_time = c.seconds;
    device.Ts = Ts;
    return device;
}

/// The request of a case, without `device` and traces.
inline TuningRequest request_of(const Case& c, const std::string& method) {
    TuningRequest request;
    request.subject = subject_of(c.plant);
    request.tune = {MethodRequest{.method = method, .options = {}}};
    request.evaluate.points = 0;
    return request;
}

/// The settings that a user reads in the answer and types, from its texts only.
inline Typed typed_of(const device::Fitted& fitted, const Case& c, double Ts) {
    Typed typed{
        .text = {}, .Ts = Ts * c.seconds, .Sy = c.spans.y_high - c.spans.y_low, .Su = c.spans.u_high - c.spans.u_low};
    for (std::size_t i = 0; i < fitted.texts.size(); ++i) typed.text[fitted.typed[i].name] = fitted.texts[i];
    return typed;
}

inline std::string words_of(const Typed& typed) {
    std::string words;
    for (const auto& [name, text] : typed.text) words += " " + name + "=" + text;
    return words;
}

}  // namespace tunewright::test
