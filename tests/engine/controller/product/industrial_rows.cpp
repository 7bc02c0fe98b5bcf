// The second design on industrial blocks.
#include "tests/engine/controller/product/second_design.h"

namespace tunewright::product::second {

namespace {

// A band in units of the measurement asks for the whole output, Su.
Row panel(const char* band, const char* I, const char* D) {
    return {{{band, Su / Kp}, {I, Ti}, {D, Td}}, {}, [=](const Typed& t, Complex s) {
                return ideal(Su / t[band], t[I], t[D], 0, 1, 0, s);
            }};
}

}  // namespace

const std::map<std::string, Row>& industrial_rows() {
    static const std::map<std::string, Row> rows{
        {"siemens_pid_compact",
         {{{"Gain", Kp}, {"Ti", Ti}, {"Td", Td}, {"TdFiltRatio", Tf / Td}, {"PWeighting", b}, {"DWeighting", 0}},
          {},
          [](const Typed& t, Complex s) {
              return ideal(t["Gain"], t["Ti"], t["Td"], t["TdFiltRatio"] * t["Td"], t["PWeighting"], t["DWeighting"],
                           s);
          }}},
        {"siemens_fb41_cont_c",
         {{{"GAIN", Kn}, {"TI_s", Ti}, {"TD_s", Td}, {"TM_LAG_s", Tf}},
          {{"P_SEL", "true"}, {"I_SEL", "true"}, {"D_SEL", "true"}},
          [](const Typed& t, Complex s) {
              return ideal(t["GAIN"] * Su / Sy, t["TI_s"], t["TD_s"], t["TM_LAG_s"], 1, 1, s);
          }}},
        {"rockwell_pid_independent",
         {{{"KP", Kn}, {"KI", Kn / Ti}, {"KD", Kn * Td}},
          {{"PE", "0"}, {"DOE", "0"}},
          [](const Typed& t, Complex s) {
              return parallel(t["KP"] * Su / Sy, t["KI"] * Su / Sy, t["KD"] * Su / Sy, 0, 1, 0, s);
          }}},
        {"rockwell_pid_dependent",
         {{{"KP", Kn}, {"KI", Ti / 60}, {"KD", Td / 60}},
          {{"PE", "1"}, {"DOE", "0"}},
          [](const Typed& t, Complex s) { return ideal(t["KP"] * Su / Sy, 60 * t["KI"], 60 * t["KD"], 0, 1, 0, s); }}},
        {"rockwell_slc_pid",
         {{{"KC_RG1", 100 * Kn}, {"TI_RG1", 100 * Ti / 60}, {"TD", 100 * Td / 60}},
          {{"RG", "1"}},
          [](const Typed& t, Complex s) {
              return ideal(t["KC_RG1"] / 100 * Su / Sy, 0.6 * t["TI_RG1"], 0.6 * t["TD"], 0, 1, 0, s);
          }}},
        {"rockwell_pide_independent",
         {{{"PGain", Kn}, {"IGain", 60 * Kn / Ti}, {"DGain", Kn * Td / 60}},
          {{"DependIndepend", "false"}, {"PVEProportional", "true"}, {"PVEDerivative", "true"}},
          [](const Typed& t, Complex s) {
              return parallel(t["PGain"] * Su / Sy, t["IGain"] / 60 * Su / Sy, t["DGain"] * 60 * Su / Sy, 0, 0, 0, s);
          }}},
        {"rockwell_pide_dependent",
         {{{"PGain", Kn}, {"IGain", Ti / 60}, {"DGain", Td / 60}},
          {{"DependIndepend", "true"}, {"PVEProportional", "true"}, {"PVEDerivative", "true"}},
          [](const Typed& t, Complex s) {
              return ideal(t["PGain"] * Su / Sy, 60 * t["IGain"], 60 * t["DGain"], 0, 0, 0, s);
          }}},
        {"schneider_pidff_mixed",
         {{{"kp", Kp}, {"ti_s", Ti}, {"td_s", Td}, {"kd", Td / Tf}, {"ovs_att", 1 - b}},
          {{"mix_par", "0"}, {"pv_dev", "PV"}},
          [](const Typed& t, Complex s) {
              return ideal(t["kp"], t["ti_s"], t["td_s"], t["td_s"] / t["kd"], 1 - t["ovs_att"], 0, s);
          }}},
        {"schneider_pidff_parallel",
         {{{"kp", Kp},
           {"ti_s", Su / Sy * Ti / Kp},
           {"td_s", Kp * Td / (Su / Sy)},
           {"kd", Kp * Td / (Su / Sy) / Tf},
           {"ovs_att", 1 - b}},
          {{"mix_par", "1"}, {"pv_dev", "PV"}},
          [](const Typed& t, Complex s) {
              const double q = Su / Sy;
              return parallel(t["kp"], q / t["ti_s"], q * t["td_s"], t["td_s"] / t["kd"], 1 - t["ovs_att"], 0, s);
          }}},
        {"abb_fc19",
         {{{"K", 1}, {"KP", Kp}, {"KI", 60 * Kp / Ti}, {"KD", Kp * Td / 60}},
          {{"S11", "integral only"}},
          [](const Typed& t, Complex s) {
              return parallel(t["K"] * t["KP"], t["K"] * t["KI"] / 60, t["K"] * t["KD"] * 60, 0, 0, 0, s);
          }}},
        {"abb_drive_pid",
         {{{"gain", Kn}, {"integration_time", Ti}, {"derivation_time", Td}, {"derivation_filter", Tf}},
          {},
          [](const Typed& t, Complex s) {
              return ideal(t["gain"] * Su / Sy, t["integration_time"], t["derivation_time"], t["derivation_filter"], 1,
                           1, s);
          }}},
        {"abb_knx_aba",
         {{{"ProportionalCoefficient", Kp}, {"IntegralTime", Ti / Kp}, {"DerivativeTime", Kp * Td}},
          {},
          [](const Typed& t, Complex s) {
              return parallel(t["ProportionalCoefficient"], 1 / t["IntegralTime"], t["DerivativeTime"], 0, 1, 1, s);
          }}},
        {"abb_ac800m_pidcc",
         {{{"Gain", Kp}, {"Ti", Ti}, {"Td", Td}, {"Tf", Tf}},
          {},
          [](const Typed& t, Complex s) { return ideal(t["Gain"], t["Ti"], t["Td"], t["Tf"], 1, 0, s); }}},
        {"emerson_deltav_standard",
         {{{"GAIN", Kn}, {"RESET", Ti}, {"RATE", Td}, {"ALPHA", Tf / Td}, {"BETA", b}, {"GAMMA", 0}},
          {{"FORM", "Standard"}, {"STRUCTURE", "Two degrees of freedom controller"}},
          [](const Typed& t, Complex s) {
              return ideal(t["GAIN"] * Su / Sy, t["RESET"], t["RATE"], t["ALPHA"] * t["RATE"], t["BETA"], t["GAMMA"],
                           s);
          }}},
        {"emerson_deltav_series",
         {{{"GAIN", Kn * kDeltaV.gain()}, {"RESET", kDeltaV.ti}, {"RATE", kDeltaV.td}, {"ALPHA", 0.125}},
          {{"FORM", "Series"}, {"STRUCTURE", "PI action on error, D action on PV"}},
          [](const Typed& t, Complex s) { return series(t["GAIN"] * Su / Sy, t["RESET"], t["RATE"], t["ALPHA"], s); }}},
        {"honeywell_interactive_b",
         {{{"K", Kn * kHoneywell.gain()}, {"T1", kHoneywell.ti / 60}, {"T2", kHoneywell.td / 60}},
          {{"equation", "B"}},
          [](const Typed& t, Complex s) { return series(t["K"] * Su / Sy, 60 * t["T1"], 60 * t["T2"], 0.1, s); }}},
        {"honeywell_ideal",
         {{{"K", Kn}, {"T1", Ti / 60}, {"T2", Td / 60}},
          {{"equation", "C"}},
          [](const Typed& t, Complex s) { return ideal(t["K"] * Su / Sy, 60 * t["T1"], 60 * t["T2"], 0, 0, 0, s); }}},
        {"yokogawa_ff_pid",
         {{{"GAIN", Kn}, {"RESET", Ti}, {"RATE", Td}},
          {{"MODE", "Auto"}},
          [](const Typed& t, Complex s) { return ideal(t["GAIN"] * Su / Sy, t["RESET"], t["RATE"], 0, 0, 0, s); }}},
        {"yokogawa_centum_pid",
         {{{"PB", 100 / Kn}, {"TI", Ti}, {"TD", Td}},
          {{"type", "I-PD"}},
          [](const Typed& t, Complex s) { return ideal(100 / t["PB"] * Su / Sy, t["TI"], t["TD"], 0, 0, 0, s); }}},
        {"foxboro_pid",
         {{{"PBAND", 100 * Ti / (Kn * kFoxboro.ti)},
           {"INT", kFoxboro.ti / 60},
           {"DERIV", kFoxboro.td / 60},
           {"KD", Td / Tf}},
          {},
          [](const Typed& t, Complex s) {
              const double INT = 60 * t["INT"], DERIV = 60 * t["DERIV"];
              const double tau = 1 / (t["KD"] * (1 / INT + 1 / DERIV));
              Law law = series(100 / t["PBAND"] * Su / Sy, INT, DERIV, 0, s);
              law.y /= 1.0 + tau * s + 0.5 * tau * tau * s * s;
              return law;
          }}},
        {"omron_pid190",
         {{{"P", 1000 / Kn}, {"Tik_0_1s", 10 * Ti}, {"Tdk_0_1s", 10 * Td}},
          {{"time_unit", "9"}, {"alpha_code", "165"}},
          [](const Typed& t, Complex s) {
              const double ti = t["Tik_0_1s"] / 10, alpha = 0.65;
              // The set-point filter stands before P and I; D acts on the measurement.
              const Complex F = (1.0 + (1 - alpha) * ti * s) / (1.0 + ti * s);
              Law law = ideal(1000 / t["P"] * Su / Sy, ti, t["Tdk_0_1s"] / 10, 0, 1, 0, s);
              law.r *= F;
              return law;
          }}},
        {"mitsubishi_fx_pid",
         {{{"KP", 100 * Kn}, {"TI", 10 * Ti}, {"TD", 100 * Td}, {"KD", 100 * Tf / Td}, {"alpha", 0}, {"TS", 250}},
          {},
          [](const Typed& t, Complex s) {
              return ideal(t["KP"] / 100 * Su / Sy, t["TI"] / 10, t["TD"] / 100, t["KD"] / 100 * t["TD"] / 100, 1, 0,
                           s);
          }}},
        {"omron_nj_pidat",
         {{{"ProportionalBand", 100 / Kn}, {"IntegrationTime_s", Ti}, {"DerivativeTime_s", Td}, {"alpha", 1 - b}},
          {},
          [](const Typed& t, Complex s) {
              const double ti = t["IntegrationTime_s"];
              // The set-point filter stands before P and I; D acts on the measurement.
              const Complex F = (1.0 + (1 - t["alpha"]) * ti * s) / (1.0 + ti * s);
              Law law = ideal(100 / t["ProportionalBand"] * Su / Sy, ti, t["DerivativeTime_s"], 0, 1, 0, s);
              law.r *= F;
              return law;
          }}},
        {"delta_dpid",
         {{{"Kc_Kp", Kp}, {"Ti_Ki", Ti}, {"Td_Kd", Td}, {"Tf", Tf}},
          {{"PID_EQ", "true"}, {"PID_DE", "true"}},
          [](const Typed& t, Complex s) { return ideal(t["Kc_Kp"], t["Ti_Ki"], t["Td_Kd"], t["Tf"], 1, 0, s); }}},
        {"automationdirect_directlogic",
         {{{"GAIN", Kn}, {"RESET", Ti}, {"RATE", Td}, {"LIMIT", Td / Tf}},
          {{"limit_enabled", "true"}, {"reset_unit", "seconds"}},
          [](const Typed& t, Complex s) {
              return ideal(t["GAIN"] * Su / Sy, t["RESET"], t["RATE"], t["RATE"] / t["LIMIT"], 1, 0, s);
          }}},
        {"eurotherm_3200", panel("PB", "TI", "TD")},
        {"watlow_ez_zone", panel("h_Pb", "ti", "td")},
        {"omron_e5", panel("P", "I", "D")},
        {"delta_dt", panel("PB", "Ti", "Td")},
        {"yokogawa_ut_advanced",
         {{{"P", 100 / Kn}, {"I", Ti}, {"D", Td}},
          {{"ALG", "1"}},
          [](const Typed& t, Complex s) { return ideal(100 / t["P"] * Su / Sy, t["I"], t["D"], 0, 0, 0, s); }}},
        {"beckhoff_fb_ctrl_pid",
         {{{"fKp", Kp}, {"tTn_ms", 1000 * Ti}, {"tTv_ms", 1000 * Td}, {"tTd_ms", 1000 * Tf}},
          {{"bPInTheFeedbackPath", "true"}, {"bDInTheFeedbackPath", "true"}},
          [](const Typed& t, Complex s) {
              return ideal(t["fKp"], t["tTn_ms"] / 1000, t["tTv_ms"] / 1000, t["tTd_ms"] / 1000, 0, 0, s);
          }}},
        {"codesys_util_pid",
         {{{"KP", Kp}, {"TN", Ti}, {"TV", Td}},
          {},
          [](const Typed& t, Complex s) { return ideal(t["KP"], t["TN"], t["TV"], 0, 1, 1, s); }}},
    };
    return rows;
}

}  // namespace tunewright::product::second
