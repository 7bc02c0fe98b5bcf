#include "tests/engine/request/own_programs.h"

namespace tunewright::test {
namespace {

using Maker = std::function<OwnProgram(const Typed&)>;

OwnProgram turned(OwnProgram program) {
    return [program = std::move(program)](double y) { return -program(y); };
}

// Ti typed as 0 means off in all blocks that document it; an integral gain of 0 is off by itself.
double over(double K, double time) { return time > 0 ? K / time : 0; }

OwnProgram compact(const Typed& t) {
    const double K = t.number("Gain"), Td = t.number("Td");
    return summing(K, over(K, t.number("Ti")), K * Td, t.number("TdFiltRatio") * Td, t.Ts);
}

OwnProgram logix_independent(const Typed& t) {
    const double q = t.Su / t.Sy;
    return summing(q * t.number("KP"), q * t.number("KI"), q * t.number("KD"), 0, t.Ts);
}

OwnProgram logix_dependent(const Typed& t) {
    const double K = t.Su / t.Sy * t.number("KP");
    return summing(K, over(K, 60 * t.number("KI")), K * 60 * t.number("KD"), 0, t.Ts);
}

OwnProgram pide_independent(const Typed& t) {
    const double q = t.Su / t.Sy;
    return velocity(q * t.number("PGain"), q * t.number("IGain") / 60, q * 60 * t.number("DGain"), t.Ts);
}

OwnProgram pide_dependent(const Typed& t) {
    const double K = t.Su / t.Sy * t.number("PGain");
    return velocity(K, over(K, 60 * t.number("IGain")), K * 60 * t.number("DGain"), t.Ts);
}

OwnProgram knx(const Typed& t) {
    return summing(t.number("ProportionalCoefficient"), over(1, t.number("IntegralTime")), t.number("DerivativeTime"),
                   0, t.Ts);
}

OwnProgram yokogawa(const Typed& t) {
    const double K = t.Su / t.Sy * t.number("GAIN");
    return velocity(K, K / t.number("RESET"), K * t.number("RATE"), t.Ts);
}

OwnProgram omron(const Typed& t) {
    const double K = 1000 / t.number("P") * t.Su / t.Sy, Tik = t.number("Tik_0_1s");
    return summing(K, Tik == 9999 ? 0 : K / (Tik / 10), K * t.number("Tdk_0_1s") / 10, 0, t.Ts);
}

OwnProgram oscat(const Typed& t) {
    const double K = t.number("KP");
    return trapezoidal_sum(K, K / t.number("TN"), K * t.number("TV"), t.Ts);
}

OwnProgram labview(const Typed& t) {
    const double K = t.number("Kc");
    return trapezoidal_sum(K, K / (60 * t.number("Ti_min")), K * 60 * t.number("Td_min"), t.Ts);
}

OwnProgram pidstd(const Typed& t) {
    const double K = t.number("Kp"), Td = t.number("Td");
    return forward_euler(K, K / t.number("Ti"), K * Td, t.text.contains("N") ? Td / t.number("N") : 0, t.Ts);
}

OwnProgram matlab(const Typed& t) {
    return forward_euler(t.number("Kp"), t.number("Ki"), t.number("Kd"), t.number("Tf", 0), t.Ts);
}

OwnProgram autotuner(const Typed& t) {
    const double K = t.number("P"), D = t.number("D");
    return summing(K, K / t.number("I"), K * D, t.text.contains("N") ? D / t.number("N") : 0, t.Ts);
}

OwnProgram simple_pid(const Typed& t) { return summing(t.number("Kp"), t.number("Ki"), t.number("Kd"), 0, t.Ts); }

OwnProgram arduino(const Typed& t) {
    const double duty = t.Su / 255;
    return summing(duty * t.number("Kp"), duty * t.number("Ki"), duty * t.number("Kd"), 0, t.Ts);
}

OwnProgram reprap(const Typed& t) {
    const double duty = t.Su / 255;
    return slopes(duty * t.number("P"), duty * t.number("I"), duty * t.number("D"), 4, t.Ts);
}

OwnProgram esphome(const Typed& t) {
    const int M = static_cast<int>(t.number("derivative_averaging_samples", 8));
    return slopes(t.Su * t.number("kp"), t.Su * t.number("ki"), t.Su * t.number("kd"), M, t.Ts);
}

OwnProgram smart_thermostat(const Typed& t) {
    const double percent = t.Su / 100;
    return summing(percent * t.number("kp"), percent * t.number("ki"), percent * t.number("kd"), 0, t.Ts);
}

// Versatile Thermostat: coef_int times the error; the outdoor part is constant.
OwnProgram versatile(const Typed& t) {
    return [K = t.Su * t.number("coef_int")](double y) { return -K * y; };
}

OwnProgram ardupilot(const Typed& t) {
    return summing(t.number("P"), t.number("I"), t.number("D"), time_of_cutoff(t.number("FLTD")), t.Ts);
}

OwnProgram px4(const Typed& t) {
    const double K = t.number("K");
    return late_integral(K * t.number("P"), K * t.number("I"), K * t.number("D"), 0, t.Ts);
}

OwnProgram betaflight(const Typed& t) {
    const double cutoff = t.text.contains("dterm_lpf1_hz") ? t.number("dterm_lpf1_hz") : 0;
    return summing(0.032029 * t.number("P"), 0.244381 * t.number("I"), 0.000529 * t.number("D"), time_of_cutoff(cutoff),
                   t.Ts);
}

OwnProgram discrete_pids(const Typed& t) {
    const double K = t.number("K"), Td = t.number("Td"), Ts = t.number("Ts");
    return late_integral(K, K / t.number("Ti"), K * Td, Td / t.number("N", 10), Ts);
}

OwnProgram epid(const Typed& t) {
    const double K = t.number("KP");
    return summing(K, K * t.number("KI"), K * t.number("KD"), 0, t.Ts);
}

OwnProgram ros(const Typed& t) { return summing(t.number("p"), t.number("i"), t.number("d"), 0, t.Ts); }

// Foxboro PID: OUT = (100/PBAND)(1 + 1/(INT s))(SP - (1 + DERIV s) y_f), y_f through 1/(1 + Tf s + (Tf s)^2/2), 1/Tf =
// KD (1/INT + 1/DERIV); its sampling is not documented: backward Euler throughout.
OwnProgram foxboro(const Typed& t) {
    const double K = 100 / t.number("PBAND") * t.Su / t.Sy, INT = 60 * t.number("INT"), DERIV = 60 * t.number("DERIV"),
                 Ts = t.Ts, Tf = DERIV > 0 ? 1 / (t.number("KD") * (1 / INT + 1 / DERIV)) : 0;
    return [=, f1 = 0.0, f2 = 0.0, sum = 0.0](double y) mutable {
        // y_f + Tf dy_f/dt + Tf^2/2 d2y_f/dt2 = y.
        const double a = Tf / Ts, b = a * a / 2;
        const double f = (y + (a + 2 * b) * f1 - b * f2) / (1 + a + b);
        const double e = -(f + DERIV * (f - f1) / Ts);
        f2 = f1;
        f1 = f;
        sum += e * Ts / INT;
        return K * (e + sum);
    };
}

// Honeywell interactive, equation B: CV = K (1 + 1/(T1 s)) (SP - (T2 s + 1)/(0.1 T2 s + 1) PV), as above.
OwnProgram honeywell(const Typed& t) {
    const double K = t.number("K") * t.Su / t.Sy, T1 = 60 * t.number("T1"), T2 = 60 * t.number("T2"), Ts = t.Ts;
    return [=, lead = 0.0, last = 0.0, sum = 0.0](double y) mutable {
        lead = (0.1 * T2 * lead + (Ts + T2) * y - T2 * last) / (Ts + 0.1 * T2);
        last = y;
        sum += -lead * Ts / T1;
        return K * (-lead + sum);
    };
}

/// For blocks with a switch: its name, and its value for a plant with negative gain.
struct Switch {
    std::string name, direct;
};

const std::map<std::string, std::pair<Maker, Switch>>& programs() {
    static const std::map<std::string, std::pair<Maker, Switch>> all = {
        {"siemens_pid_compact", {compact, {"InvertControl", "true"}}},
        {"rockwell_pid_independent", {logix_independent, {"CA", "1"}}},
        {"rockwell_pid_dependent", {logix_dependent, {"CA", "1"}}},
        {"rockwell_pide_independent", {pide_independent, {"ControlAction", "true"}}},
        {"rockwell_pide_dependent", {pide_dependent, {"ControlAction", "true"}}},
        {"abb_knx_aba", {knx, {"deviation", "inverted"}}},
        {"emerson_deltav_standard", {[](const Typed& t) { return deltav(t, false); }, {}}},
        {"emerson_deltav_series", {[](const Typed& t) { return deltav(t, true); }, {}}},
        {"yokogawa_ff_pid", {yokogawa, {"Direct Acting", "true"}}},
        {"omron_pid190", {omron, {"forward_reverse", "forward"}}},
        {"mitsubishi_fx_pid", {mitsubishi, {}}},
        {"openplc_iec_pid", {openplc, {}}},
        {"oscat_ctrl_pid", {oscat, {}}},
        {"labview_pid", {labview, {}}},
        {"matlab_pidstd", {pidstd, {}}},
        {"matlab_pid", {matlab, {}}},
        {"simulink_pid_autotuner_block", {autotuner, {}}},
        {"simple_pid", {simple_pid, {}}},
        {"arduino_pid_v1", {arduino, {"ControllerDirection", "REVERSE"}}},
        {"quickpid", {arduino, {"ControllerDirection", "REVERSE"}}},
        {"marlin", {marlin, {}}},
        {"klipper", {klipper, {}}},
        {"reprapfirmware", {reprap, {"M307_I", "1"}}},
        {"esphome_pid", {esphome, {}}},
        {"ha_smart_thermostat", {smart_thermostat, {"ac_mode", "true"}}},
        {"ha_versatile_thermostat_tpi", {versatile, {"hvac_mode", "cool"}}},
        {"ardupilot_ac_pid", {ardupilot, {}}},
        {"px4_rate", {px4, {}}},
        {"betaflight", {betaflight, {}}},
        {"controlsystems_jl_pid", {tustin, {}}},
        {"discretepids_jl", {discrete_pids, {}}},
        {"epics_epid", {epid, {}}},
        {"ros_control_toolbox", {ros, {}}},
        {"foxboro_pid", {foxboro, {"INCOPT", "true"}}},
        {"honeywell_interactive_b", {honeywell, {"CTLACTN", "DIRECT"}}},
    };
    return all;
}

}  // namespace

OwnProgram own_program(const std::string& product, const Typed& typed) {
    const auto& [make, direct] = programs().at(product);
    OwnProgram program = make(typed);
    return !direct.name.empty() && typed.is(direct.name, direct.direct) ? turned(std::move(program)) : program;
}

}  // namespace tunewright::test
