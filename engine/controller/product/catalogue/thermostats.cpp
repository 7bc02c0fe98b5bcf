// Home thermostats: ESPHome, HASmartThermostat, Versatile Thermostat.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kPercent = 100;

// Gains for a duty cycle from 0 to `full`.
std::vector<Parameter> gains(double full, std::string_view unit, std::string_view unit_I, std::string_view unit_D) {
    const auto part = [&](std::string_view name, std::string_view of, ParameterRole role, Term term) {
        return Parameter{.name = name,
                         .label = name,
                         .unit = of,
                         .role = role,
                         .term = times(full, of_output(term)),
                         .range = {0, kUnbounded}};
    };
    return {part("kp", unit, ParameterRole::gain, kKp), part("ki", unit_I, ParameterRole::integral, kKi),
            part("kd", unit_D, ParameterRole::derivative, kKd)};
}

Product esphome() {
    std::vector<Parameter> parameters = gains(1, "1/degC", "1/(degC s)", "s/degC");
    parameters.push_back({.name = "derivative_averaging_samples",
                          .label = "derivative_averaging_samples",
                          .role = ParameterRole::filter,
                          .shape = Shape::slope_samples,
                          .range = {1, kUnbounded},
                          .resolution = kWholeNumber,
                          .standard = 8.0});
    return {
        .id = "esphome_pid",
        .maker = "ESPHome",
        .name = "ESPHome climate: pid",
        .families = {"Home Assistant", "ESP32"},
        .form = Form::parallel,
        .law = "duty = kp e + (ki/s) e - kd (mean slope of y over M samples), duty from -1 to 1",
        .gain_basis = "duty per degree",
        .parameters = std::move(parameters),
        .filter = {FilterKind::slope, 0,
                   "A mean of M slopes, without the changes of the set point. The output may be averaged too."},
        .weights = {1, 0, "P acts on the error, D on the measurement."},
        .action = {.kind = Action::Kind::reverse_only, .text = "A positive output heats, a negative one cools."},
        .algorithm = {.derivative = DerivativeRule::slope,
                      .text = "position algorithm",
                      .anti_windup = "min_integral and max_integral",
                      .sample_time_text = "the sensor's update_interval, measured"},
        .traps = {"Inside the dead band the multipliers are 0 by default: P, I and D vanish there.",
                  "With a slow sensor 8 samples are a long delay: at 60 s four minutes."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole controller", "defaults of the structure"},
                     .unverified = {"defaults of min_integral and max_integral in YAML"},
                     .sources = {"esphome/esphome esphome/components/pid/pid_controller.cpp",
                                 "esphome.io components/climate/pid"}},
        .example = of_design_a({{"kp", 0.015}, {"ki", 0.000125}, {"kd", 0.3}, {"derivative_averaging_samples", 17.0}}),
        .snippets = {{"YAML, in climate with platform: pid",
                      "control_parameters:\n"
                      "  kp: {kp}\n"
                      "  ki: {ki}\n"
                      "  kd: {kd}\n"
                      "  derivative_averaging_samples: {derivative_averaging_samples}"}},
    };
}

Product ha_smart() {
    return {
        .id = "ha_smart_thermostat",
        .maker = "ScratMan",
        .name = "HASmartThermostat (Home Assistant)",
        .form = Form::parallel,
        .law = "percent = kp e + (ki/s) e - kd s y",
        .gain_basis = "percent per degree",
        .parameters = gains(kPercent, "%/degC", "%/(degC s)", "% s/degC"),
        .filter = {FilterKind::none},
        .weights = {1, 0, "P acts on the error, D on the measurement."},
        .action = {.kind = Action::Kind::switched,
                   .name = "ac_mode",
                   .direct = true,
                   .reverse = false,
                   .text = "ac_mode sets cooling."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm with pulse width; differences between events of the sensor",
                      .anti_windup = "it integrates only while the last output was within its limits",
                      .sample_time_text = "keep_alive or sampling_period; 0: on every event"},
        .traps = {"A fork takes ki in % per degC and hour: a factor of 3600.",
                  "generic_thermostat is a relay with hysteresis, not this."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"PID.calc"},
                     .unverified = {"newer versions"},
                     .sources = {"ScratMan/HASmartThermostat custom_components/smart_thermostat/pid_controller"}},
        .example = of_design_a({{"kp", 1.5}, {"ki", 0.0125}, {"kd", 30.0}}),
        .snippets = {{"configuration.yaml, in climate with platform: smart_thermostat",
                      "kp: {kp}\n"
                      "ki: {ki}\n"
                      "kd: {kd}\n"
                      "ac_mode: {ac_mode|false}"}},
    };
}

Product versatile() {
    return {
        .id = "ha_versatile_thermostat_tpi",
        .maker = "jmcollin78",
        .name = "Versatile Thermostat TPI (Home Assistant)",
        .form = Form::p_only,
        .law = "duty = coef_int (r - y) + coef_ext (r - outdoor)",
        .gain_basis = "duty per degree",
        .parameters =
            {
                {.name = "coef_int",
                 .label = "coef_int",
                 .unit = "1/degC",
                 .role = ParameterRole::gain,
                 .term = of_output(kKp),
                 .range = {0, kUnbounded}},
                {.name = "coef_ext",
                 .label = "coef_ext",
                 .unit = "1/degC",
                 .role = ParameterRole::limit,
                 .shape = Shape::constant,
                 .elsewhere = true,
                 .remark = "feeds the outdoor temperature forward: 1/(degrees that full power holds)"},
            },
        .filter = {FilterKind::none},
        .weights = {1, 0, "It has only P."},
        .action = {.kind = Action::Kind::switched,
                   .name = "hvac_mode",
                   .direct = std::string("cool"),
                   .reverse = std::string("heat"),
                   .text = "hvac_mode sets the direction."},
        .algorithm = {.text = "pulse width over cycle_min",
                      .anti_windup = "the duty is clamped to 0..1",
                      .sample_time_text = "cycle_min, in minutes"},
        .traps = {"It is not a PID: it has no Ti and Td, and coef_ext removes the steady-state error."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole class", "the action set_tpi_parameters"},
                     .sources = {"jmcollin78/versatile_thermostat prop_algorithm.py, services.yaml at 0c2008cd",
                                 "its README, Change TPI Parameters"}},
        .example = of_design_a({{"coef_int", 0.015}}),
        .snippets = {{"YAML of an action, in Developer tools or a script",
                      "# with hvac_mode {hvac_mode|heat}\n"
                      "action: versatile_thermostat.set_tpi_parameters\n"
                      "target:\n"
                      "  entity_id: climate.room\n"
                      "data:\n"
                      "  tpi_coef_int: {coef_int}"}},
    };
}

}  // namespace

std::vector<Product> thermostat_products() { return {esphome(), ha_smart(), versatile()}; }

}  // namespace tunewright::product
