// Flight controllers: ArduPilot AC_PID, PX4 rate control, Betaflight.
#include <numbers>

#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

/// Cut-off of a first-order filter in Hz.
constexpr Term kCutoff{.factor = 1 / (2 * std::numbers::pi), .Tf = -1};

Parameter switched_off(std::string_view name) {
    return {.name = name,
            .label = name,
            .unit = "Hz",
            .role = ParameterRole::fixed,
            .shape = Shape::constant,
            .standard = 0.0,
            .remark = "0: no filter"};
}

Parameter gain_of(std::string_view name, std::string_view label, std::string_view unit, ParameterRole role, Term term) {
    return {.name = name, .label = label, .unit = unit, .role = role, .term = term};
}

Product ardupilot() {
    IdealPid design = kRateDesign;
    design.c = 1;
    return {
        .id = "ardupilot_ac_pid",
        .maker = "ArduPilot",
        .name = "AC_PID",
        .families = {"ArduCopter", "Pixhawk"},
        .form = Form::parallel,
        .law = "out = P e + (I/s) e + (D s/(Tf s + 1)) e, Tf = 1/(2 pi FLTD)",
        .gain_basis = "normalised output per rad/s",
        .parameters = {gain_of("P", "P", "", ParameterRole::gain, kKp),
                       gain_of("I", "I", "1/s", ParameterRole::integral, kKi),
                       gain_of("D", "D", "s", ParameterRole::derivative, kKd),
                       {.name = "FLTD",
                        .label = "FLTD",
                        .unit = "Hz",
                        .role = ParameterRole::filter,
                        .term = kCutoff,
                        .range = {0, kUnbounded},
                        .standard = 20.0,
                        .off = 0.0},
                       switched_off("FLTE"),
                       switched_off("FLTT"),
                       {.name = "IMAX",
                        .label = "IMAX",
                        .unit = "output",
                        .role = ParameterRole::limit,
                        .shape = Shape::constant,
                        .elsewhere = true}},
        .filter = {FilterKind::parameter, 0, "First order at FLTD; FLTE would filter the whole error."},
        .weights = {1, 1, "All parts act on the error; FF adds to b."},
        .action = kSigned,
        .algorithm = {.text = "position algorithm",
                      .anti_windup = "at a limit the integral can only decrease; IMAX",
                      .sample_time_text = "the loop's rate, 400 Hz or more"},
        .traps = {"SMAX limits the slew rate: it scales P and D during operation."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"update_all, update_i", "defaults"},
                     .unverified = {"body of the filter's helper", "notch and D_FF of newer versions"},
                     .sources = {"ArduPilot/ardupilot libraries/AC_PID/AC_PID.cpp, AC_PID.h"}},
        .example =
            {.design = design,
             .y_span = 1,
             .u_span = 1,
             .sample_time_s = 0.0025,
             .settings = {{"P", 0.135}, {"I", 0.135}, {"D", 0.0036045}, {"FLTD", 20.0}, {"FLTE", 0.0}, {"FLTT", 0.0}}},
        .snippets = {{"Parameter file, for roll",
                      "ATC_RAT_RLL_P,{P}\n"
                      "ATC_RAT_RLL_I,{I}\n"
                      "ATC_RAT_RLL_D,{D}\n"
                      "ATC_RAT_RLL_FLTD,{FLTD}\n"
                      "ATC_RAT_RLL_FLTE,{FLTE}\n"
                      "ATC_RAT_RLL_FLTT,{FLTT}"}},
    };
}

Product px4() {
    return {
        .id = "px4_rate",
        .maker = "PX4",
        .name = "Rate control (MC_*RATE_*)",
        .families = {"Pixhawk", "PX4"},
        .form = Form::parallel,
        .law = "out = K [ P e + (I/s) e - D s y ] + FF r, e = r - y",
        .gain_basis = "normalised torque per rad/s",
        .parameters = {gain_of("K", "MC_*RATE_K", "", ParameterRole::multiplier, kKp),
                       gain_of("P", "MC_*RATE_P", "", ParameterRole::gain, {.Kp = 1, .K = -1}),
                       gain_of("I", "MC_*RATE_I", "1/s", ParameterRole::integral, {.Kp = 1, .Ti = -1, .K = -1}),
                       gain_of("D", "MC_*RATE_D", "s", ParameterRole::derivative, {.Kp = 1, .Td = 1, .K = -1}),
                       {.name = "FF",
                        .label = "MC_*RATE_FF",
                        .role = ParameterRole::weight_b,
                        .shape = Shape::feedforward,
                        .range = {0, kUnbounded},
                        .standard = 0.0,
                        .remark = "never negative, so b is at least 1"}},
        .filter = {FilterKind::unknown, 0,
                   "IMU_DGYRO_CUTOFF filters the angular acceleration before the controller; its order is not known."},
        .weights = {1, 0, "FF makes b = 1 + FF/(K P); D acts on the measured angular acceleration."},
        .action = kSigned,
        .algorithm = {.integral = IntegralRule::forward,
                      .derivative = DerivativeRule::difference,
                      .text = "position algorithm; the output uses the integral before its update",
                      .anti_windup = "flags of saturation, limits, and an integral that shrinks with the error: "
                                     "1 - (e/400 deg/s)^2",
                      .sample_time_text = "the gyro's rate"},
        .traps = {"K scales all three."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"update, updateIntegral", "option K", "D in the feedback"},
                     .unverified = {"order and default of the angular acceleration's filter"},
                     .sources = {"PX4/PX4-Autopilot src/lib/rate_control/rate_control.cpp", "PX4 pull request 12472",
                                 "docs.px4.io, multicopter PID tuning guide"}},
        .example = {.design = kRateDesign,
                    .y_span = 1,
                    .u_span = 1,
                    .sample_time_s = 0.0025,
                    .settings = {{"K", 0.135}, {"P", 1.0}, {"I", 1.0}, {"D", 0.0267}, {"FF", 0.0}}},
        .snippets = {{"Console, for roll",
                      "param set MC_ROLLRATE_K {K}\n"
                      "param set MC_ROLLRATE_P {P}\n"
                      "param set MC_ROLLRATE_I {I}\n"
                      "param set MC_ROLLRATE_D {D}\n"
                      "param set MC_ROLLRATE_FF {FF}\n"
                      "param save"}},
    };
}

Product betaflight() {
    constexpr double kP = 0.032029, kI = 0.244381, kD = 0.000529;
    const auto slider = [](std::string_view name, ParameterRole role, double low, Term term) {
        return Parameter{.name = name,
                         .label = name,
                         .role = role,
                         .term = term,
                         .range = {low, kUnbounded},
                         .usual_max = 250,
                         .resolution = kWholeNumber,
                         .remark = "Recent versions accept up to 250."};
    };
    return {
        .id = "betaflight",
        .maker = "Betaflight",
        .name = "Rate PID",
        .families = {"FPV"},
        .form = Form::parallel,
        .law = "sum = 0.032029 P e + (0.244381 I/s) e - (0.000529 D s/(Tf s + 1)) y, Tf = 1/(2 pi dterm_lpf1)",
        .gain_basis = "sum of the PID (limit 500, mixed by 1/1000) per deg/s",
        .parameters = {slider("P", ParameterRole::gain, 1, times(1 / kP, kKp)),
                       slider("I", ParameterRole::integral, 0, times(1 / kI, kKi)),
                       slider("D", ParameterRole::derivative, 0, times(1 / kD, kKd)),
                       {.name = "dterm_lpf1_hz",
                        .label = "dterm_lpf1",
                        .unit = "Hz",
                        .role = ParameterRole::filter,
                        .term = kCutoff,
                        .range = {1, kUnbounded},
                        .resolution = kWholeNumber}},
        .filter = {FilterKind::parameter, 0,
                   "One or two filters of the derivative (PT1, PT2, PT3, biquad); this is one "
                   "PT1."},
        .weights = {1, 0, "P acts on the error, D on the gyro; feedforward is separate, F 0.013754/100."},
        .action = {.kind = Action::Kind::reverse_only, .text = "Its sliders are never negative."},
        .algorithm = {.text = "position algorithm",
                      .anti_windup = "limit and relaxation of the integral, anti-gravity",
                      .sample_time_text = "the loop of gyro and PID"},
        .traps = {"On yaw, I is multiplied by 2.5 unless integrated yaw is used.",
                  "Throttle attenuation, D max and I relaxation are not linear."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"constants of the scales", "D on the gyro", "I of yaw times 2.5", "largest slider"},
                     .unverified = {"filters of newer versions"},
                     .sources = {"betaflight pid_init.c and pid.h (public copies of several revisions)"}},
        .example = {.design = {.Kp = 1.6,
                               .Ti = 0.08,
                               .Td = 0.014,
                               .b = 1,
                               .c = 0,
                               .filter = {FilterType::derivative, 0.00176839}},
                    .y_span = 1,
                    .u_span = 1,
                    .sample_time_s = 0.00025,
                    .settings = {{"P", 50.0}, {"I", 82.0}, {"D", 42.0}, {"dterm_lpf1_hz", 90.0}}},
        .snippets = {{"CLI, for roll",
                      "set simplified_pids_mode = OFF\n"
                      "set simplified_dterm_filter = OFF\n"
                      "set dterm_lpf1_dyn_min_hz = 0\n"
                      "set p_roll = {P}\n"
                      "set i_roll = {I}\n"
                      "set d_roll = {D}\n"
                      "set dterm_lpf1_static_hz = {dterm_lpf1_hz}\n"
                      "save"}},
    };
}

}  // namespace

std::vector<Product> flight_products() { return {ardupilot(), px4(), betaflight()}; }

}  // namespace tunewright::product
