// Firmware of 3D printers: Marlin, Klipper, RepRapFirmware. Gains are in counts of 255 per degree.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kPwmCounts = 255;

std::vector<Parameter> gains(std::string_view P, std::string_view I, std::string_view D, std::string_view unit,
                             std::string_view unit_I, std::string_view unit_D) {
    const auto in_counts = [](Term term) { return times(kPwmCounts, of_output(term)); };
    return {{.name = P,
             .label = P,
             .unit = unit,
             .role = ParameterRole::gain,
             .term = in_counts(kKp),
             .range = {0, kUnbounded}},
            {.name = I,
             .label = I,
             .unit = unit_I,
             .role = ParameterRole::integral,
             .term = in_counts(kKi),
             .range = {0, kUnbounded}},
            {.name = D,
             .label = D,
             .unit = unit_D,
             .role = ParameterRole::derivative,
             .term = in_counts(kKd),
             .range = {0, kUnbounded}}};
}

std::vector<Parameter> with(std::vector<Parameter> parameters, Parameter last) {
    parameters.push_back(std::move(last));
    return parameters;
}

constexpr std::string_view kHeater = "P acts on the error, D on the measurement.";

Product marlin() {
    return {
        .id = "marlin",
        .maker = "Marlin",
        .name = "Marlin hotend and bed PID (M301, M304)",
        .families = {"Ender", "Prusa", "Creality"},
        .form = Form::parallel,
        .law = "pwm = P e + (I/s) e - (D s/(Tf s + 1)) y, Tf = dt PID_K1/(1 - PID_K1), pwm from 0 to 255",
        .gain_basis = "counts of 255 per degree",
        .parameters = with(gains("P", "I", "D", "counts/degC", "counts/(degC s)", "counts s/degC"),
                           {.name = "PID_K1",
                            .label = "PID_K1 (compiled in)",
                            .role = ParameterRole::filter,
                            .shape = Shape::lag_per_sample,
                            .range = {0, 0.9999},
                            .standard = 0.95,
                            .compiled_in = true,
                            .remark = "changed only by compiling the firmware; 0.95 is a Tf of 19 periods"}),
        .filter = {FilterKind::parameter, 0,
                   "First order with PID_K1 of the firmware's source; 0.95 makes Tf = 19 periods, 3.1 s."},
        .weights = {1, 0, kHeater},
        .action = {.kind = Action::Kind::reverse_only, .text = "It heats only."},
        .algorithm = {.text = "position algorithm",
                      .anti_windup = "the integral stays between 0 and the largest output; "
                                     "more than 10 degC from the target the heater is full on or off",
                      .sample_time_s = 0.1638,
                      .firmware_clock = true,
                      .sample_time_text = "PID_dT follows from the board's temperature timer."},
        .traps = {"The EEPROM stores the unscaled gains, the program the scaled ones.",
                  "M301 does not show the derivative's filter of 3 s."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"class PID_t", "macros that scale", "defaults"},
                     .unverified = {"PID_dT of a given board"},
                     .sources = {"MarlinFirmware/Marlin Marlin/src/module/temperature.h",
                                 "configurations with PID_K1 0.95 (several public copies)"}},
        .example = of_design_a({{"P", 3.825}, {"I", 0.031875}, {"D", 76.5}, {"PID_K1", 0.9243}}),
        .snippets = {{"G-code for the hotend",
                      "; with PID_K1 {PID_K1} in Configuration.h\n"
                      "M301 P{P} I{I} D{D}\n"
                      "M500"},
                     {"G-code for the bed",
                      "; with PID_K1 {PID_K1} in Configuration.h\n"
                      "M304 P{P} I{I} D{D}\n"
                      "M500"}},
    };
}

Product klipper() {
    return {
        .id = "klipper",
        .maker = "Klipper",
        .name = "Klipper heater (control: pid)",
        .families = {"Voron", "Mainsail", "Fluidd", "OctoPrint"},
        .form = Form::parallel,
        .law = "duty = [ pid_Kp e + (pid_Ki/s) e - (pid_Kd s/(Tf s + 1)) y ]/255, Tf = smooth_time - dt",
        .gain_basis = "1/255 of full power per degree",
        .parameters = with(gains("pid_Kp", "pid_Ki", "pid_Kd", "1/255 per degC", "1/255 per degC s", "s/255 per degC"),
                           {.name = "smooth_time",
                            .label = "smooth_time",
                            .unit = "s",
                            .role = ParameterRole::filter,
                            .shape = Shape::plus_clock,
                            .range = {0, kUnbounded},
                            .standard = 1.0,
                            .remark = "2.0 by default in older versions"}),
        .filter = {FilterKind::parameter, 0, "First order, Tf = smooth_time less one period."},
        .weights = {1, 0, kHeater},
        .action = {.kind = Action::Kind::reverse_only,
                   .text = "A heater only heats; temperature_fan inverts the "
                           "sign."},
        .algorithm = {.text = "position algorithm",
                      .anti_windup =
                          "the integral stays between 0 and max_power/Ki and stops while the output is limited",
                      .sample_time_s = 0.3,
                      .firmware_clock = true,
                      .sample_time_text = "A thermistor reports every 0.3 s."},
        .traps = {"smooth_time was 2.0 s by default in older versions.",
                  "Forks have a velocity form (pid_v) and other filters."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"class ControlPID", "documentation"},
                     .unverified = {"report time of 0.3 s"},
                     .sources = {"Klipper3d/klipper klippy/extras/heaters.py at 84104bbb (2026-08)",
                                 "docs/Config_Reference.md"}},
        .example = of_design_a({{"pid_Kp", 3.825}, {"pid_Ki", 0.031875}, {"pid_Kd", 76.5}, {"smooth_time", 2.3}}),
        .snippets = {{"printer.cfg, in [extruder] or [heater_bed] instead of the lines of these names",
                      "control: pid\n"
                      "pid_Kp: {pid_Kp}\n"
                      "pid_Ki: {pid_Ki}\n"
                      "pid_Kd: {pid_Kd}\n"
                      "smooth_time: {smooth_time}"}},
    };
}

Product reprapfirmware() {
    constexpr double kSlopeSamples = 4;
    return {
        .id = "reprapfirmware",
        .maker = "Duet3D",
        .name = "RepRapFirmware 3 (M301)",
        .families = {"Duet 2", "Duet 3"},
        .form = Form::parallel,
        .law = "duty = [ P e + (I/s) e - D (slope of y over four samples) ]/255",
        .gain_basis = "1/255 of full power per degree",
        .parameters = gains("P", "I", "D", "1/255 per degC", "1/255 per degC s", "s/255 per degC"),
        .filter = {FilterKind::slope, kSlopeSamples, "A slope over four samples of 0.25 s, fixed."},
        .weights = {1, 0, kHeater},
        .action = {.kind = Action::Kind::switched,
                   .name = "M307_I",
                   .direct = 1.0,
                   .reverse = 0.0,
                   .text = "M307 with I1 inverts the heater's direction."},
        .algorithm = {.derivative = DerivativeRule::slope,
                      .text = "position algorithm; computed in the ideal form inside",
                      .anti_windup = "the integral stays between 0 and the largest output; while P and D alone reach a "
                                     "limit it is preset",
                      .sample_time_s = 0.25,
                      .firmware_clock = true,
                      .sample_time_text = "Heaters are served every 250 ms."},
        .traps = {"M301 replaces both the gains for loads and those for set points.",
                  "Slopes above 10 degC/s are ignored.",
                  "The duty cycle is corrected by the square of the supply "
                  "voltage."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"SetM301PidParameters", "control law"},
                     .unverified = {"constant of 250 ms"},
                     .sources = {"Duet3D/RepRapFirmware src/Heating/FOPDT.cpp, LocalHeater.cpp, LocalHeater.h"}},
        .example = of_design_a({{"P", 3.825}, {"I", 0.031875}, {"D", 76.5}}),
        .snippets = {{"config.g, for heater 1",
                      "M301 H1 P{P} I{I} D{D}\n"
                      "; add I{M307_I|0} to M307 H1"}},
    };
}

}  // namespace

std::vector<Product> printer_products() { return {marlin(), klipper(), reprapfirmware()}; }

}  // namespace tunewright::product
