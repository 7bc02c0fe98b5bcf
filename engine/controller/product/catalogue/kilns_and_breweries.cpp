// Kilns and breweries: kiln-controller, CraftBeerPi, BrewBlox (BrewPi).
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kPercentOfDuty = 100;

/// A gain in percent of the duty per degree.
constexpr Term of_duty(Term term) { return times(kPercentOfDuty, of_output(term)); }

Product kiln_controller() {
    return {
        .id = "kiln_controller",
        .maker = "jbruce12000",
        .name = "kiln-controller (Raspberry Pi)",
        .families = {"kiln", "pottery", "ceramics"},
        .form = Form::parallel,
        .law = "duty in % = pid_kp e + (1/(pid_ki s)) e + pid_kd s e",
        .gain_basis = "percent of the duty per degree",
        .parameters =
            {
                {.name = "pid_kp",
                 .label = "pid_kp",
                 .unit = "%/deg",
                 .role = ParameterRole::gain,
                 .term = of_duty(kKp),
                 .range = {0, kUnbounded}},
                {.name = "pid_ki",
                 .label = "pid_ki",
                 .unit = "deg s/%",
                 .role = ParameterRole::integral,
                 .term = {.factor = 1 / kPercentOfDuty, .Kp = -1, .Ti = 1, .Su = 1},
                 .range = {0, kUnbounded},
                 .remark = "the inverse of an integral gain: a smaller number integrates faster, and 0 divides by 0"},
                {.name = "pid_kd",
                 .label = "pid_kd",
                 .unit = "% s/deg",
                 .role = ParameterRole::derivative,
                 .term = of_duty(kKd),
                 .range = {0, kUnbounded}},
            },
        .filter = {FilterKind::none, 0, "None; the temperature is a median of the readings of a cycle."},
        .weights = {1, 1, "All three parts act on the error."},
        .action = {.kind = Action::Kind::reverse_only, .text = "It only heats."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm within pid_control_window, full or no power outside it",
                      .anti_windup = "the integral stops outside pid_control_window; within it nothing limits it",
                      .sample_time_s = 2,
                      .sample_time_text = "sensor_time_wait, 2 s by default; measured in whole seconds"},
        .traps = {"pid_ki is a divisor: a larger pid_ki gives a weaker integral action.",
                  "Outside pid_control_window it is an on/off controller; the window is 5 degrees by default.",
                  "Newer versions compute in degrees Celsius whatever temp_scale is; older ones in temp_scale.",
                  "Elapsed time is counted in whole seconds, which makes short cycles uneven."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole class PID and its caller", "comments and defaults of the settings"},
                     .sources = {"jbruce12000/kiln-controller lib/oven.py at 001a9850, config.py at 024fb4f2"}},
        .example = of_design_a({{"pid_kp", 1.5}, {"pid_ki", 80.0}, {"pid_kd", 30.0}}),
        .snippets = {{"config.py",
                      "pid_kp = {pid_kp}\n"
                      "pid_ki = {pid_ki}\n"
                      "pid_kd = {pid_kd}"}},
    };
}

Product craftbeerpi() {
    return {
        .id = "craftbeerpi_pidboil",
        .maker = "CraftBeerPi",
        .name = "CraftBeerPi 3 and 4, kettle logic PIDBoil",
        .families = {"CraftBeerPi", "cbpi4", "brewing"},
        .form = Form::parallel,
        .law = "duty in % = P e + (I/s) e - D s y",
        .gain_basis = "percent of the duty per degree",
        .parameters =
            {
                {.name = "P",
                 .label = "P",
                 .unit = "%/deg",
                 .role = ParameterRole::gain,
                 .term = of_duty(kKp),
                 .range = {0, kUnbounded}},
                {.name = "I",
                 .label = "I",
                 .unit = "%/(deg s)",
                 .role = ParameterRole::integral,
                 .term = of_duty(kKi),
                 .range = {0, kUnbounded}},
                {.name = "D",
                 .label = "D",
                 .unit = "% s/deg",
                 .role = ParameterRole::derivative,
                 .term = of_duty(kKd),
                 .range = {0, kUnbounded}},
            },
        .filter = {FilterKind::none},
        .weights = {1, 0, "P acts on the error, D on the measurement."},
        .action = {.kind = Action::Kind::reverse_only, .text = "It only heats."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm with pulse width",
                      .anti_windup = "it integrates only while the last output was within its limits, and the integral "
                                     "is clamped to them",
                      .sample_time_s = 5,
                      .sample_time_text = "5 s, fixed in the code and assumed by the formulas"},
        .traps = {"Above the boil threshold, 80 degrees by default, it heats with full power.",
                  "CraftBeerPi 4 reads the threshold under a misspelt name: a changed one has no effect.",
                  "Its first derivative is computed as if the measurement had stepped from 0 degrees, which lowers the "
                  "first output.",
                  "The integral rests while the output is exactly 0 or at its maximum."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole plugin of version 4 and the class PIDArduino of version 3"},
                     .unverified = {"other plugins with the same class and another sample time"},
                     .sources = {"PiBrewing/cbpi4-PIDBoil cbpi4-PIDBoil/__init__.py at 06c5f617",
                                 "the plugin PIDBoil of CraftBeerPi 3"}},
        .example = of_design_a({{"P", 1.5}, {"I", 0.0125}, {"D", 30.0}}),
    };
}

Product brewblox() {
    constexpr double kMaxUnsignedWord = 65535;
    return {
        .id = "brewblox_pid",
        .maker = "BrewPi",
        .name = "BrewBlox PID (BrewPi Spark)",
        .families = {"BrewPi", "BrewBlox", "Spark"},
        .form = Form::ideal,
        .law = "output in % = Kp [ e + (1/(Ti s)) e - Td s y ], y filtered",
        .gain_basis = "percent per degree Celsius",
        .parameters =
            {
                {.name = "Kp", .label = "Kp", .unit = "%/degC", .role = ParameterRole::gain, .term = of_duty(kKp)},
                {.name = "Ti",
                 .label = "Ti",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kMaxUnsignedWord},
                 .resolution = kWholeNumber,
                 .off = 0.0},
                {.name = "Td",
                 .label = "Td",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kMaxUnsignedWord},
                 .resolution = kWholeNumber},
            },
        .filter =
            {FilterKind::unknown, 0,
             "The derivative is that of a filtered measurement over about Td/2, by a filter that is not known. P and I "
             "use the filter of the sensor pair."},
        .weights = {1, 0, "P acts on the error, D on the measurement."},
        .action = {.kind = Action::Kind::signed_gain, .text = "A negative Kp cools."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "back-calculation from what the actuator reaches, with a gain of 3, which never "
                                     "changes the sign of the integral",
                      .sample_time_s = 1,
                      .sample_time_text = "1 s, which the integral assumes"},
        .traps = {"At a set point of 100 degC or more the boil mode switches the integral off.",
                  "A change of Kp or Ti keeps the integral part of the output.",
                  "The older BrewPi firmware for Arduino has other parameters."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"Pid::update", "the types of the settings", "the period of 1000 ms"},
                     .unverified = {"filter of the derivative", "unit of the output (percent of the duty assumed)"},
                     .sources = {"BrewBlox/brewblox-firmware lib/src/Pid.cpp, lib/inc/Pid.h at 065caeed, "
                                 "lib/inc/SetpointSensorPair.h at ed23694e",
                                 "app/brewblox/blox/PidBlock.h"}},
        .example = of_design_a({{"Kp", 1.5}, {"Ti", 120.0}, {"Td", 20.0}}),
    };
}

}  // namespace

std::vector<Product> kiln_and_brewery_products() { return {kiln_controller(), craftbeerpi(), brewblox()}; }

}  // namespace tunewright::product
