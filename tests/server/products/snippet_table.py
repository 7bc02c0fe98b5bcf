"""Each text to paste: its reader, and the setting that each name in it must hold."""

from snippet_readers import (BIT, BOOL, NUMBER, PLACES, REAL, TIME, epics_database, g_code, ioc_shell, julia,
                             klipper, lim_pid, lines_of, matlab_controller, octave_control, python_control,
                             python_settings, set_param, simple_pid, sketch, structured_text, yaml_text)

PERIOD_S = 0.25


def of(name, default=None, scale=1, words=None):
    """The setting as it is typed, or `default`; None if the text must not have it."""
    def value(typed):
        text = typed.get(name, default)
        if words and text is not None:
            return words[text]
        return text if scale == 1 or text is None else scale * float(text)
    return value


def fixed(value):
    return lambda typed: value


def members(variable, **rows):
    """Type of each member, or type and setting if the setting has another name; "__" stands for a point."""
    rows = {name.replace("__", "."): row if isinstance(row, tuple) else (row, of(name)) for name, row in rows.items()}
    return (structured_text(variable, {name: kind for name, (kind, _) in rows.items()}),
            {name: source for name, (_, source) in rows.items()})


def transfer_function(typed):
    Kp, Ki, Kd, Tf = (float(typed.get(name, 0)) for name in ("Kp", "Ki", "Kd", "Tf"))
    return {f"C({s})": fixed(Kp + Ki / s + Kd * s / (Tf * s + 1)) for s in PLACES}


def same_names(*names):
    return {name: of(name) for name in names}


def calls(**sources):
    """The sources of the arguments of each call, by "call argument"."""
    return {f"{call} {name}": source for call, names in sources.items() for name, source in names.items()}


VARIABLES = {"input": fixed("Input"), "output": fixed("Output"), "setpoint": fixed("Setpoint")}
GAINS = same_names("Kp", "Ki", "Kd")
DIRECTION = of("ControllerDirection", "DIRECT", words={"DIRECT": 0, "REVERSE": 1})
P_ON = of("POn", words={"P_ON_M": 0, "P_ON_E": 1})
PID_V1 = {
    "PID": VARIABLES | GAINS | {"POn": P_ON, "direction": DIRECTION},
    "SetSampleTime": {"ms": fixed(1000 * PERIOD_S)},
    "SetTunings": GAINS | {"POn": P_ON},
}
QUICKPID = {
    "QuickPID": VARIABLES | GAINS | {
        "pMode": of("pMode", words={"pOnError": 0, "pOnMeas": 1, "pOnErrorMeas": 2}),
        "dMode": of("dMode", words={"dOnError": 0, "dOnMeas": 1}), "iAwMode": fixed(1), "action": DIRECTION},
    "SetSampleTimeUs": {"us": fixed(1e6 * PERIOD_S)},
}
LOGIX_PID = members("Loop", KP=REAL, KI=REAL, KD=REAL, PE=BIT, DOE=BIT, CA=(BIT, of("CA", "0")))
LOGIX_PIDE = members("Loop", PGain=REAL, IGain=REAL, DGain=REAL, DependIndepend=BIT, PVEProportional=BIT,
                     PVEDerivative=BIT, ControlAction=(BIT, of("ControlAction", "0")))
MARLIN_COMMENT = {"PID_K1": rf"with PID_K1 ({NUMBER}) in Configuration\.h"}


def marlin(code):
    gains = {f"{code} {name}": of(name) for name in "PID"}
    return g_code({code: "PID", "M500": ""}, MARLIN_COMMENT), gains | {"M500": fixed(""), "PID_K1": of("PID_K1")}


# product: a list of (reader, sources); sources may be a function of the typed settings.
SNIPPETS = {
    "siemens_pid_compact": [members(
        '"PID_Compact_1"', **{f"Retain__CtrlParams__{name}": (REAL, of(name)) for name in
                              ("Gain", "Ti", "Td", "TdFiltRatio", "PWeighting", "DWeighting")},
        Config__InvertControl=(BOOL, of("InvertControl", "false")))],
    "siemens_fb41_cont_c": [members(
        '"CONT_C_DB"', GAIN=REAL, TI=(TIME, of("TI_s", scale=1000)), TD=(TIME, of("TD_s", scale=1000)),
        TM_LAG=(TIME, of("TM_LAG_s", scale=1000)), P_SEL=BOOL, I_SEL=BOOL, D_SEL=BOOL)],
    "rockwell_pid_independent": [LOGIX_PID],
    "rockwell_pid_dependent": [LOGIX_PID],
    "rockwell_pide_independent": [LOGIX_PIDE],
    "rockwell_pide_dependent": [LOGIX_PIDE],
    "beckhoff_fb_ctrl_pid": [members(
        "stParams", fKp=REAL, tTn=(TIME, of("tTn_ms")), tTv=(TIME, of("tTv_ms")), tTd=(TIME, of("tTd_ms")),
        bPInTheFeedbackPath=BOOL, bDInTheFeedbackPath=BOOL)],
    "codesys_util_pid": [members("loop", KP=REAL, TN=REAL, TV=REAL)],
    "openplc_iec_pid": [members("loop", KP=REAL, TR=REAL, TD=REAL, CYCLE=(TIME, of("CYCLE_s", scale=1000)))],
    "oscat_ctrl_pid": [members("loop", KP=REAL, TN=REAL, TV=REAL)],
    "epics_epid": [(ioc_shell, same_names("KP", "KI", "KD")), (epics_database, same_names("KP", "KI", "KD"))],
    "matlab_pidstd": [(matlab_controller("pidstd", ("Kp", "Ti", "Td", "N")),
                       same_names("Kp", "Ti", "Td") | {"N": of("N", "Inf")})],
    "matlab_pid": [(matlab_controller("pid", ("Kp", "Ki", "Kd", "Tf")), GAINS | {"Tf": of("Tf", "0")})],
    "matlab_pidstd2": [(matlab_controller("pidstd2", ("Kp", "Ti", "Td", "N", "b", "c")),
                        same_names("Kp", "Ti", "Td", "b") | {"N": of("N", "Inf"), "c": of("c", "0")})],
    "matlab_pid2": [(matlab_controller("pid2", ("Kp", "Ki", "Kd", "Tf", "b", "c")),
                     GAINS | same_names("b") | {"Tf": of("Tf", "0"), "c": of("c", "0")})],
    "modelica_limpid": [(lim_pid, same_names("controllerType", "k", "wp") | {
        "Ti": of("Ti", "0.5"), "Td": of("Td", "0.1"), "Nd": of("Nd", "10"), "wd": of("wd", "0"),
        "yMax": fixed("Modelica.Constants.inf")})],
    "simulink_pid_parallel": [(set_param, {"Controller": fixed("PID")} |
                               same_names("P", "I", "D", "N", "Form", "b", "c"))],
    "simulink_pid_ideal": [(set_param, {"Controller": fixed("PID")} | same_names("P", "I", "D", "N", "Form"))],
    "simple_pid": [(simple_pid, GAINS | {"setpoint": fixed(0), "sample_time": fixed(PERIOD_S)} |
                    same_names("proportional_on_measurement", "differential_on_measurement"))],
    "controlsystems_jl_pid": [(julia, same_names("param_p", "param_i", "param_d", "form", "Tf", "filter_order"))],
    "discretepids_jl": [(julia, same_names("K", "Ti", "Td", "N", "wp", "wd", "Tt", "Ts"))],
    "ros_control_toolbox": [(yaml_text(), {f"gains.joint.{name}": of(name) for name in "pid"} | {
        "gains.joint.i_clamp_max": of("i_clamp"), "gains.joint.i_clamp_min": of("i_clamp", scale=-1)})],
    "python_control": [(python_control, transfer_function)],
    "octave_control": [(octave_control, transfer_function)],
    "arduino_pid_v1": [(sketch("double", PID_V1), calls(**PID_V1))],
    "quickpid": [(sketch("float", QUICKPID), calls(**QUICKPID))],
    "marlin": [marlin("M301"), marlin("M304")],
    "klipper": [(klipper, {name.lower(): of(name) for name in ("pid_Kp", "pid_Ki", "pid_Kd", "smooth_time")} |
                 {"control": fixed("pid")})],
    "reprapfirmware": [(g_code({"M301": "HPID"}, {"M307 I": r"add I([01]) to M307 H1"}),
                        {"M301 H": fixed(1), "M301 P": of("P"), "M301 I": of("I"), "M301 D": of("D"),
                         "M307 I": of("M307_I", "0")})],
    "esphome_pid": [(yaml_text(), {f"control_parameters.{name}": of(name) for name in
                                   ("kp", "ki", "kd", "derivative_averaging_samples")})],
    "ha_smart_thermostat": [(yaml_text(), same_names("kp", "ki", "kd") | {"ac_mode": of("ac_mode", "false")})],
    "ha_versatile_thermostat_tpi": [(yaml_text({"hvac_mode": r"with hvac_mode (heat|cool)"}), {
        "action": fixed("versatile_thermostat.set_tpi_parameters"), "target.entity_id": fixed("climate.room"),
        "data.tpi_coef_int": of("coef_int"), "hvac_mode": of("hvac_mode", "heat")})],
    "kiln_controller": [(python_settings, same_names("pid_kp", "pid_ki", "pid_kd"))],
    "ardupilot_ac_pid": [(lines_of(rf"ATC_RAT_RLL_([A-Z]+),({NUMBER})"),
                          same_names("P", "I", "D", "FLTD", "FLTE", "FLTT"))],
    "px4_rate": [(lines_of(rf"param set MC_ROLLRATE_([A-Z]+) ({NUMBER})", ("param save",)),
                  same_names("K", "P", "I", "D", "FF") | {"param save": fixed("")})],
    "betaflight": [(lines_of(r"set ([a-z0-9_]+) = (\d+|OFF)", ("save",)), {
        "simplified_pids_mode": fixed("OFF"), "simplified_dterm_filter": fixed("OFF"),
        "dterm_lpf1_dyn_min_hz": fixed(0), "p_roll": of("P"), "i_roll": of("I"), "d_roll": of("D"),
        "dterm_lpf1_static_hz": of("dterm_lpf1_hz"), "save": fixed("")})],
}


def expected(sources, typed):
    """What the text must hold, by name."""
    rows = sources(typed) if callable(sources) else sources
    return {name: value for name, source in rows.items() if (value := source(typed)) is not None}
