// The second design for heaters and small boards, and for software.
#include "tests/engine/controller/product/second_design.h"

namespace tunewright::product::second {

namespace {

// With duties of 255, of 1 or of 100.
Row heater(double full, const char* P, const char* I, const char* D) {
    return {{{P, full * Kp / Su}, {I, full * Kp / (Su * Ti)}, {D, full * Kp * Td / Su}}, {}, {}};
}
std::function<Law(const Typed&, Complex)> heating(double full, const char* P, const char* I, const char* D, double wb,
                                                  std::function<double(const Typed&)> filter) {
    return [=](const Typed& t, Complex s) {
        return parallel(t[P] / full * Su, t[I] / full * Su, t[D] / full * Su, filter(t), wb, 0, s);
    };
}

std::map<std::string, Row> heaters() {
    std::map<std::string, Row> rows;
    const auto none = [](const Typed&) { return 0.0; };
    Row& marlin = rows["marlin"] = heater(255, "P", "I", "D");
    marlin.numbers["PID_K1"] = Tf / (Tf + 0.1638);
    marlin.block =
        heating(255, "P", "I", "D", 1, [](const Typed& t) { return t["PID_K1"] * 0.1638 / (1 - t["PID_K1"]); });
    Row& klipper = rows["klipper"] = heater(255, "pid_Kp", "pid_Ki", "pid_Kd");
    klipper.numbers["smooth_time"] = Tf + 0.3;
    klipper.block =
        heating(255, "pid_Kp", "pid_Ki", "pid_Kd", 1, [](const Typed& t) { return t["smooth_time"] - 0.3; });
    Row& rrf = rows["reprapfirmware"] = heater(255, "P", "I", "D");
    // Four samples of 0.25 s delay a slope by 0.5 s, a difference by 0.125 s.
    rrf.block = heating(255, "P", "I", "D", 1, [](const Typed&) { return 0.5 - 0.125; });
    Row& esphome = rows["esphome_pid"] = heater(1, "kp", "ki", "kd");
    esphome.numbers["derivative_averaging_samples"] = 1 + 2 * Tf / Ts;
    esphome.block = heating(1, "kp", "ki", "kd", 1,
                            [](const Typed& t) { return t["derivative_averaging_samples"] * Ts / 2 - Ts / 2; });
    Row& smart = rows["ha_smart_thermostat"] = heater(100, "kp", "ki", "kd");
    smart.block = heating(100, "kp", "ki", "kd", 1, none);
    rows["ha_versatile_thermostat_tpi"] = {{{"coef_int", Kp / Su}}, {}, [](const Typed& t, Complex) {
                                               const double P = t["coef_int"] * Su;
                                               return Law{P, P};
                                           }};
    Row& arduino = rows["arduino_pid_v1"] = heater(255, "Kp", "Ki", "Kd");
    arduino.words = {{"POn", "P_ON_M"}};
    arduino.block = heating(255, "Kp", "Ki", "Kd", 0, none);
    Row& quick = rows["quickpid"] = heater(255, "Kp", "Ki", "Kd");
    quick.words = {{"pMode", "pOnErrorMeas"}, {"dMode", "dOnMeas"}};
    quick.block = heating(255, "Kp", "Ki", "Kd", 0.5, none);
    // A duty of 100 % of the output's span; pid_ki divides.
    rows["kiln_controller"] = {
        {{"pid_kp", 100 * Kp / Su}, {"pid_ki", Su * Ti / (100 * Kp)}, {"pid_kd", 100 * Kp * Td / Su}},
        {},
        [](const Typed& t, Complex s) {
            const double full = Su / 100;
            return parallel(t["pid_kp"] * full, full / t["pid_ki"], t["pid_kd"] * full, 0, 1, 1, s);
        }};
    Row& beer = rows["craftbeerpi_pidboil"] = heater(100, "P", "I", "D");
    beer.block = heating(100, "P", "I", "D", 1, none);
    rows["brewblox_pid"] = {{{"Kp", 100 * Kp / Su}, {"Ti", Ti}, {"Td", Td}}, {}, [](const Typed& t, Complex s) {
                                return ideal(t["Kp"] * Su / 100, t["Ti"], t["Td"], 0, 1, 0, s);
                            }};
    return rows;
}

// A transfer function of the error.
Row transfer_function() {
    return {{{"Kp", Kp}, {"Ki", Kp / Ti}, {"Kd", Kp * Td}, {"Tf", Tf}}, {}, [](const Typed& t, Complex s) {
                const Complex C = t["Kp"] + t["Ki"] / s + t["Kd"] * s / (t["Tf"] * s + 1.0);
                return Law{C, C};
            }};
}

}  // namespace

const std::map<std::string, Row>& heater_rows() {
    static const std::map<std::string, Row> rows = heaters();
    return rows;
}

const std::map<std::string, Row>& software_rows() {
    static const std::map<std::string, Row> rows{
        {"openplc_iec_pid",
         {{{"KP", -Kp}, {"TR", Ti}, {"TD", Td}, {"CYCLE_s", Ts}},
          {},
          // Its error is PV - SP.
          [](const Typed& t, Complex s) { return ideal(-t["KP"], t["TR"], t["TD"], t["CYCLE_s"], 1, 1, s); }}},
        {"oscat_ctrl_pid",
         {{{"KP", Kp}, {"TN", Ti}, {"TV", Td}},
          {},
          [](const Typed& t, Complex s) { return ideal(t["KP"], t["TN"], t["TV"], 0, 1, 1, s); }}},
        {"labview_pid",
         {{{"Kc", Kp}, {"Ti_min", Ti / 60}, {"Td_min", Td / 60}, {"beta", b}, {"gamma", 0}},
          {{"VI", "PID Advanced.vi"}},
          [](const Typed& t, Complex s) {
              return ideal(t["Kc"], 60 * t["Ti_min"], 60 * t["Td_min"], 0, t["beta"], t["gamma"], s);
          }}},
        {"matlab_pidstd",
         {{{"Kp", Kp}, {"Ti", Ti}, {"Td", Td}, {"N", Td / Tf}},
          {},
          [](const Typed& t, Complex s) { return ideal(t["Kp"], t["Ti"], t["Td"], t["Td"] / t["N"], 1, 1, s); }}},
        {"matlab_pid",
         {{{"Kp", Kp}, {"Ki", Kp / Ti}, {"Kd", Kp * Td}, {"Tf", Tf}},
          {},
          [](const Typed& t, Complex s) { return parallel(t["Kp"], t["Ki"], t["Kd"], t["Tf"], 1, 1, s); }}},
        {"matlab_pidstd2",
         {{{"Kp", Kp}, {"Ti", Ti}, {"Td", Td}, {"N", Td / Tf}, {"b", b}, {"c", 0}},
          {},
          [](const Typed& t, Complex s) {
              return ideal(t["Kp"], t["Ti"], t["Td"], t["Td"] / t["N"], t["b"], t["c"], s);
          }}},
        {"matlab_pid2",
         {{{"Kp", Kp}, {"Ki", Kp / Ti}, {"Kd", Kp * Td}, {"Tf", Tf}, {"b", b}, {"c", 0}},
          {},
          [](const Typed& t, Complex s) { return parallel(t["Kp"], t["Ki"], t["Kd"], t["Tf"], t["b"], t["c"], s); }}},
        {"modelica_limpid",
         {{{"k", Kp}, {"Ti", Ti}, {"Td", Td}, {"Nd", Td / Tf}, {"wp", b}, {"wd", 0}},
          {{"controllerType", "PID"}},
          [](const Typed& t, Complex s) {
              return ideal(t["k"], t["Ti"], t["Td"], t["Td"] / t["Nd"], t["wp"], t["wd"], s);
          }}},
        {"python_control", transfer_function()},
        {"octave_control", transfer_function()},
        {"simulink_pid_parallel",
         {{{"P", Kp}, {"I", Kp / Ti}, {"D", Kp * Td}, {"N", 1 / Tf}, {"b", b}, {"c", 0}},
          {{"Form", "Parallel"}, {"block", "PID Controller (2DOF)"}},
          [](const Typed& t, Complex s) {
              const Complex D = t["D"] * t["N"] / (1.0 + t["N"] / s);
              return Law{t["b"] * t["P"] + t["I"] / s + t["c"] * D, t["P"] + t["I"] / s + D};
          }}},
        {"simulink_pid_ideal",
         {{{"P", Kp}, {"I", 1 / Ti}, {"D", Td}, {"N", 1 / Tf}},
          {{"Form", "Ideal"}},
          [](const Typed& t, Complex s) {
              const Complex C = t["P"] * (1.0 + t["I"] / s + t["D"] * t["N"] / (1.0 + t["N"] / s));
              return Law{C, C};
          }}},
        {"simulink_pid_autotuner_block",
         {{{"P", Kp}, {"I", Ti}, {"D", Td}, {"N", Td / Tf}},
          {{"Form", "Ideal"}},
          [](const Typed& t, Complex s) { return ideal(t["P"], t["I"], t["D"], t["D"] / t["N"], 1, 1, s); }}},
        {"simple_pid",
         {{{"Kp", Kp}, {"Ki", Kp / Ti}, {"Kd", Kp * Td}},
          {{"proportional_on_measurement", "true"}, {"differential_on_measurement", "true"}},
          [](const Typed& t, Complex s) { return parallel(t["Kp"], t["Ki"], t["Kd"], 0, 0, 0, s); }}},
        {"controlsystems_jl_pid",
         {{{"param_p", Kp}, {"param_i", Ti}, {"param_d", Td}, {"Tf", Tf}, {"filter_order", 1}},
          {{"form", ":standard"}},
          [](const Typed& t, Complex s) { return ideal(t["param_p"], t["param_i"], t["param_d"], t["Tf"], 1, 1, s); }}},
        {"discretepids_jl",
         {{{"K", Kp},
           {"Ti", Ti},
           {"Td", Td},
           {"N", Td / Tf},
           {"wp", b},
           {"wd", 0},
           {"Tt", std::sqrt(Ti * Td)},
           {"Ts", Ts}},
          {},
          [](const Typed& t, Complex s) {
              return ideal(t["K"], t["Ti"], t["Td"], t["Td"] / t["N"], t["wp"], t["wd"], s);
          }}},
        {"epics_epid",
         {{{"KP", Kp}, {"KI", 1 / Ti}, {"KD", Td}},
          {},
          [](const Typed& t, Complex s) {
              const Complex C = t["KP"] * (1.0 + t["KI"] / s + t["KD"] * s);
              return Law{C, C};
          }}},
        {"ros_control_toolbox",
         {{{"p", Kp}, {"i", Kp / Ti}, {"d", Kp * Td}, {"i_clamp", Su}},
          {{"error_dot", "of the error"}},
          [](const Typed& t, Complex s) { return parallel(t["p"], t["i"], t["d"], 0, 1, 1, s); }}},
        {"ardupilot_ac_pid",
         {{{"P", Kp}, {"I", Kp / Ti}, {"D", Kp * Td}, {"FLTD", 1 / (2 * kPi * Tf)}, {"FLTE", 0}, {"FLTT", 0}},
          {},
          [](const Typed& t, Complex s) {
              return parallel(t["P"], t["I"], t["D"], 1 / (2 * kPi * t["FLTD"]), 1, 1, s);
          }}},
        {"px4_rate",
         {{{"K", Kp}, {"P", 1}, {"I", 1 / Ti}, {"D", Td}, {"FF", 0}},
          {},
          [](const Typed& t, Complex s) {
              Law law = parallel(t["K"] * t["P"], t["K"] * t["I"], t["K"] * t["D"], 0, 1, 0, s);
              law.r += t["FF"];
              return law;
          }}},
        {"betaflight",
         {{{"P", Kp / 0.032029},
           {"I", Kp / (Ti * 0.244381)},
           {"D", Kp * Td / 0.000529},
           {"dterm_lpf1_hz", 1 / (2 * kPi * Tf)}},
          {},
          [](const Typed& t, Complex s) {
              return parallel(t["P"] * 0.032029, t["I"] * 0.244381, t["D"] * 0.000529,
                              1 / (2 * kPi * t["dterm_lpf1_hz"]), 1, 0, s);
          }}},
    };
    return rows;
}

}  // namespace tunewright::product::second
