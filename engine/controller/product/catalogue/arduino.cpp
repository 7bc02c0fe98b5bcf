// Arduino: PID_v1 and QuickPID. Gains are in counts of an output from 0 to 255.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kCounts = 255;
constexpr double kPeriod = 0.1;

Parameter gain_of(std::string_view name, std::string_view unit, ParameterRole role, Term term) {
    return {.name = name,
            .label = name,
            .unit = unit,
            .role = role,
            .term = times(kCounts, of_output(term)),
            .range = {0, kUnbounded},
            .remark = "for an output of 0 to 255 counts"};
}

Action direction() {
    // DIRECT: a larger output raises the measurement, which is reverse action here.
    return {.kind = Action::Kind::switched,
            .name = "ControllerDirection",
            .direct = std::string("REVERSE"),
            .reverse = std::string("DIRECT"),
            .text =
                "ControllerDirection; DIRECT is for a plant whose measurement rises with the output. Negative gains "
                "are ignored."};
}

Product pid_v1() {
    return {
        .id = "arduino_pid_v1",
        .maker = "Brett Beauregard",
        .name = "Arduino PID_v1 1.2.1",
        .families = {"Arduino", "ESP32", "ESP8266"},
        .form = Form::parallel,
        .law = "counts = Kp (b r - y) + (Ki/s) (r - y) - Kd s y",
        .gain_basis = "counts of the output (0 to 255 by default) per unit of the measurement",
        .parameters = {gain_of("Kp", "counts/PV unit", ParameterRole::gain, kKp),
                       gain_of("Ki", "1/s", ParameterRole::integral, kKi),
                       gain_of("Kd", "s", ParameterRole::derivative, kKd),
                       {.name = "POn",
                        .label = "POn",
                        .role = ParameterRole::choice,
                        .shape = Shape::option,
                        .options = {{.value = std::string("P_ON_E"), .b = 1},
                                    {.value = std::string("P_ON_M"), .b = 0}}}},
        .filter = {FilterKind::none},
        .weights = {1, 0, "POn makes b 1 or 0; D acts on the measurement."},
        .action = direction(),
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "integral and output are clamped to the limits",
                      .sample_time_s = kPeriod,
                      .sample_time_text = "100 ms by SetSampleTime, assumed and not measured"},
        .traps = {"Negative gains are silently ignored.",
                  "A late call does not change the dt of the "
                  "computation.",
                  "In the revision that was read, SetSampleTime rescales Ki and Kd but does not store the new period: "
                  "set the gains after it, and test."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole file at revision 01cdd643"},
                     .unverified = {"the release that corresponds to that revision"},
                     .sources = {"br3ttb/Arduino-PID-Library PID_v1.cpp"}},
        .example = of_design_a({{"Kp", 3.825}, {"Ki", 0.031875}, {"Kd", 76.5}, {"POn", std::string("P_ON_E")}}),
        .snippets = {{"Sketch",
                      "PID myPID(&Input, &Output, &Setpoint, {Kp}, {Ki}, {Kd}, {POn}, {ControllerDirection|DIRECT});\n"
                      "// in setup(), in this order:\n"
                      "myPID.SetSampleTime({sample_time_ms});\n"
                      "myPID.SetTunings({Kp}, {Ki}, {Kd}, {POn});"}},
    };
}

Product quickpid() {
    return {
        .id = "quickpid",
        .maker = "dlloydev",
        .name = "QuickPID 3.1.5",
        .families = {"Arduino", "ESP32"},
        .form = Form::parallel,
        .law = "counts = Kp (b r - y) + (Ki/s) (r - y) + Kd s (c r - y)",
        .gain_basis = "counts of the output per unit of the measurement",
        .parameters = {gain_of("Kp", "counts/PV unit", ParameterRole::gain, kKp),
                       gain_of("Ki", "1/s", ParameterRole::integral, kKi),
                       gain_of("Kd", "s", ParameterRole::derivative, kKd),
                       {.name = "pMode",
                        .label = "pMode",
                        .role = ParameterRole::choice,
                        .shape = Shape::option,
                        .options = {{.value = std::string("pOnError"), .b = 1},
                                    {.value = std::string("pOnErrorMeas"), .b = 0.5},
                                    {.value = std::string("pOnMeas"), .b = 0}}},
                       {.name = "dMode",
                        .label = "dMode",
                        .role = ParameterRole::choice,
                        .shape = Shape::option,
                        .options = {{.value = std::string("dOnMeas"), .c = 0},
                                    {.value = std::string("dOnError"), .c = 1}}}},
        .filter = {FilterKind::none},
        .weights = {1, 0, "pMode makes b 1, 0.5 or 0, and dMode c 0 or 1."},
        .action = direction(),
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "iAwCondition by default; iAwClamp keeps the tuned law; iAwOff",
                      .sample_time_s = kPeriod,
                      .sample_time_text = "100 ms, by a timer of microseconds"},
        .traps = {"The default iAwCondition changes the law near the limits: use iAwClamp."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole file (a copy of 3.1.5)"},
                     .unverified = {"newer versions"},
                     .sources = {"x-radio/QuickPID src/QuickPID.cpp (copy of 3.1.5)"}},
        .example = of_design_a({{"Kp", 3.825},
                                {"Ki", 0.031875},
                                {"Kd", 76.5},
                                {"pMode", std::string("pOnErrorMeas")},
                                {"dMode", std::string("dOnMeas")}}),
        .snippets = {{"Sketch",
                      "QuickPID myPID(&Input, &Output, &Setpoint, {Kp}, {Ki}, {Kd}, QuickPID::pMode::{pMode},\n"
                      "               QuickPID::dMode::{dMode}, QuickPID::iAwMode::iAwClamp,\n"
                      "               QuickPID::Action::{ControllerDirection=REVERSE:reverse/direct});\n"
                      "// in setup():\n"
                      "myPID.SetSampleTimeUs({sample_time_us});"}},
    };
}

}  // namespace

std::vector<Product> arduino_products() { return {pid_v1(), quickpid()}; }

}  // namespace tunewright::product
