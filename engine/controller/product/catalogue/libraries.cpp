// Libraries of programming languages: simple-pid, ControlSystems.jl, DiscretePIDs.jl, Modelica, ros2_control's
// control_toolbox, python-control, Octave's package control.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

Product simple_pid() {
    return {
        .id = "simple_pid",
        .maker = "m-lundberg",
        .name = "simple-pid (Python)",
        .families = {"Raspberry Pi", "MicroPython"},
        .form = Form::parallel,
        .law = "u = Kp (b r - y) + (Ki/s) (r - y) + Kd s (c r - y)",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "Kp", .label = "Kp", .role = ParameterRole::gain, .term = kKp},
                {.name = "Ki", .label = "Ki", .unit = "1/s", .role = ParameterRole::integral, .term = kKi},
                {.name = "Kd", .label = "Kd", .unit = "s", .role = ParameterRole::derivative, .term = kKd},
                {.name = "proportional_on_measurement",
                 .label = "proportional_on_measurement",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = false, .b = 1}, {.value = true, .b = 0}}},
                {.name = "differential_on_measurement",
                 .label = "differential_on_measurement",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = true, .c = 0}, {.value = false, .c = 1}}},
            },
        .filter = {FilterKind::none},
        .weights = {1, 0, "Each is 0 or 1, by a switch."},
        .action = {.kind = Action::Kind::signed_gain, .text = "Direct action: all three gains negative."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "the integral is clamped to output_limits; by default there are none",
                      .sample_time_s = 0.01,
                      .sample_time_text = "at least 0.01 s by default; the elapsed time is measured"},
        .traps = {"Without output_limits the integral is unbounded.",
                  "error_map is applied after the difference of the errors is formed."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole file"},
                     .sources = {"m-lundberg/simple-pid simple_pid/pid.py"}},
        .example = of_design_a({{"Kp", 1.5},
                                {"Ki", 0.0125},
                                {"Kd", 30.0},
                                {"proportional_on_measurement", false},
                                {"differential_on_measurement", true}}),
        .snippets = {{"Python",
                      "from simple_pid import PID\n"
                      "\n"
                      "pid = PID({Kp}, {Ki}, {Kd}, setpoint=0, sample_time={sample_time_s})\n"
                      "pid.proportional_on_measurement = {proportional_on_measurement=true:True/False}\n"
                      "pid.differential_on_measurement = {differential_on_measurement=false:False/True}"}},
    };
}

Product control_systems() {
    return {
        .id = "controlsystems_jl_pid",
        .maker = "JuliaControl",
        .name = "ControlSystems.jl pid",
        .form = Form::ideal,
        .law = "C = param_p [ 1 + 1/(param_i s) + param_d s ], filtered by filter_order and Tf",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "param_p", .label = "param_p", .role = ParameterRole::gain, .term = kKp},
                {.name = "param_i",
                 .label = "param_i",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded}},
                {.name = "param_d",
                 .label = "param_d",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                {.name = "form",
                 .label = "form",
                 .role = ParameterRole::fixed,
                 .shape = Shape::constant,
                 .standard = std::string(":standard"),
                 .remark = ":series and :parallel use other values under the same names."},
                {.name = "Tf",
                 .label = "Tf",
                 .unit = "s",
                 .role = ParameterRole::filter,
                 .term = kTf,
                 .range = {0, kUnbounded}},
                {.name = "filter_order",
                 .label = "filter_order",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = 2.0, .filter = FilterType::measurement_second_order},
                             {.value = 1.0, .filter = FilterType::derivative}},
                 .remark = "1: filters the derivative; 2: 1/((s Tf)^2/2 + s Tf + 1) filters the whole controller."},
                {.name = "b",
                 .label = "b (pid_2dof)",
                 .role = ParameterRole::weight_b,
                 .shape = Shape::weight,
                 .standard = 1.0,
                 .elsewhere = true,
                 .remark = "only in pid_2dof"},
                {.name = "c",
                 .label = "c (pid_2dof)",
                 .role = ParameterRole::weight_c,
                 .shape = Shape::weight,
                 .standard = 1.0,
                 .elsewhere = true,
                 .remark = "only in pid_2dof, 0 by default"},
            },
        .filter = {FilterKind::chosen, 0, "filter_order 2, the default, filters the whole controller."},
        .weights = {1, 1, "pid has one input, the error; pid_2dof has b and c."},
        .action = kSigned,
        .algorithm = {.integral = IntegralRule::trapezoidal,
                      .derivative = DerivativeRule::filtered_trapezoidal,
                      .text = "a transfer function, discretised by Tustin's rule",
                      .sample_time_text = "keyword Ts"},
        .traps = {"Until pull request 1067 (2026-07) pid_2dof with N uses Tf = Kp Td/N: give Tf itself.",
                  "Until pull request 1058 Ki = 0 with filter_order 1 lost the proportional part."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"pid, pid_tf, pid_ss, pid_2dof"},
                     .sources = {"JuliaControl/ControlSystems.jl lib/ControlSystemsBase/src/pid_design.jl at b2b7dc43 "
                                 "(2026-05)",
                                 "pull requests 1058 and 1067"}},
        .example = of_design_a({{"param_p", 1.5},
                                {"param_i", 120.0},
                                {"param_d", 20.0},
                                {"form", std::string(":standard")},
                                {"Tf", 2.0},
                                {"filter_order", 1.0}}),
        .snippets =
            {{"Julia",
              "using ControlSystemsBase\n"
              "\n"
              "C = pid({param_p}, {param_i}, {param_d}; form = {form}, Tf = {Tf}, filter_order = {filter_order})"}},
    };
}

Product discrete_pids() {
    return {
        .id = "discretepids_jl",
        .maker = "JuliaControl",
        .name = "DiscretePIDs.jl",
        .form = Form::ideal,
        .law = "u = K [ (wp r - y) + (1/(Ti s)) (r - y) + (Td s/((Td/N) s + 1)) (wd r - y) ]",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "K", .label = "K", .role = ParameterRole::gain, .term = kKp},
                {.name = "Ti",
                 .label = "Ti",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded},
                 .off = 0.0},
                {.name = "Td",
                 .label = "Td",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                {.name = "N",
                 .label = "N",
                 .role = ParameterRole::filter,
                 .term = kFilterGain,
                 .range = {0, kUnbounded},
                 .standard = 10.0},
                {.name = "wp",
                 .label = "wp (b in older versions)",
                 .role = ParameterRole::weight_b,
                 .shape = Shape::weight,
                 .range = kShare,
                 .standard = 1.0},
                {.name = "wd",
                 .label = "wd",
                 .role = ParameterRole::weight_c,
                 .shape = Shape::weight,
                 .range = kShare,
                 .standard = 0.0},
                {.name = "Tt",
                 .label = "Tt",
                 .unit = "s",
                 .role = ParameterRole::limit,
                 .term = {.Ti = 0.5, .Td = 0.5},
                 .range = {0, kUnbounded},
                 .standard = 10.0,
                 .remark = "time of the back-calculation"},
                {.name = "Ts",
                 .label = "Ts",
                 .unit = "s",
                 .role = ParameterRole::sample_time,
                 .term = {.Ts = 1},
                 .range = {0, kUnbounded}},
            },
        .filter = {FilterKind::parameter, 0, "First order, Td/N."},
        .weights = {1, 0, "wp and wd can have any value."},
        .action = kSigned,
        .algorithm = {.integral = IntegralRule::forward,
                      .text = "position algorithm",
                      .anti_windup = "back-calculation with Tt",
                      .sample_time_text = "argument Ts"},
        .traps = {"b was renamed to wp, and wd was added."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole file"},
                     .sources = {"JuliaControl/DiscretePIDs.jl src/DiscretePIDs.jl at d8818560 (2025-12)"}},
        .example = of_design_a({{"K", 1.5},
                                {"Ti", 120.0},
                                {"Td", 20.0},
                                {"N", 10.0},
                                {"wp", 0.6},
                                {"wd", 0.0},
                                {"Tt", 48.9898},
                                {"Ts", 0.25}}),
        .snippets = {{"Julia",
                      "using DiscretePIDs\n"
                      "\n"
                      "controller = DiscretePID(; K = {K}, Ti = {Ti}, Td = {Td}, N = {N}, wp = {wp}, wd = {wd}, Tt = "
                      "{Tt}, Ts = {Ts})"}},
    };
}

Option controller_type(std::string_view word, bool integral, bool derivative) {
    return {.value = std::string(word), .integral = integral, .derivative = derivative};
}

Product lim_pid() {
    return {
        .id = "modelica_limpid",
        .maker = "Modelica Association",
        .name = "Modelica.Blocks.Continuous.LimPID",
        .families = {"Modelica Standard Library", "Dymola", "OpenModelica"},
        .form = Form::ideal,
        .law = "y = k [ (wp u_s - u_m) + (1/(Ti s)) (u_s - u_m) + (Td s/((Td/Nd) s + 1)) (wd u_s - u_m) ]",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "controllerType",
                 .label = "controllerType",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {controller_type("PID", true, true), controller_type("PI", true, false),
                             controller_type("PD", false, true), controller_type("P", false, false)},
                 .remark = "Modelica.Blocks.Types.SimpleController"},
                {.name = "k", .label = "k", .role = ParameterRole::gain, .term = kKp},
                {.name = "Ti",
                 .label = "Ti",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded},
                 .standard = 0.5},
                {.name = "Td",
                 .label = "Td",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded},
                 .standard = 0.1},
                {.name = "Nd",
                 .label = "Nd",
                 .role = ParameterRole::filter,
                 .term = kFilterGain,
                 .range = {0, kUnbounded},
                 .standard = 10.0,
                 .remark = "a ratio, Td/Tf"},
                {.name = "wp", .label = "wp", .role = ParameterRole::weight_b, .shape = Shape::weight, .standard = 1.0},
                {.name = "wd", .label = "wd", .role = ParameterRole::weight_c, .shape = Shape::weight, .standard = 0.0},
            },
        .filter = {FilterKind::parameter, 0, "First order, Td/Nd; it cannot be switched off."},
        .weights = {1, 0, "wp and wd, from 0."},
        .action = {.kind = Action::Kind::reverse_only,
                   .text = "k is at least 0; for direct action negate the output of the block and its measurement's "
                           "error."},
        .algorithm = {.text = "a block in continuous time",
                      .anti_windup = "back-calculation with the time Ni Ti, Ni 0.9 by default",
                      .sample_time_text = "none; the solver chooses its steps"},
        .traps = {"yMax has no default, and yMin is -yMax by default: set the limits of your actuator.",
                  "Ti and Td are 0.5 s and 0.1 s if they are left out."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"the whole block"},
                     .sources = {"Modelica Standard Library, Modelica/Blocks/Continuous.mo, LimPID"}},
        .example = of_design_a({{"controllerType", std::string("PID")},
                                {"k", 1.5},
                                {"Ti", 120.0},
                                {"Td", 20.0},
                                {"Nd", 10.0},
                                {"wp", 0.6},
                                {"wd", 0.0}}),
        .snippets =
            {{"Modelica",
              "Modelica.Blocks.Continuous.LimPID "
              "controller(controllerType=Modelica.Blocks.Types.SimpleController.{controllerType}, k={k}, "
              "Ti={Ti|0.50}, Td={Td|0.10}, Nd={Nd|10.00}, wp={wp}, wd={wd|0.00}, yMax=Modelica.Constants.inf);"}},
    };
}

Product ros() {
    return {
        .id = "ros_control_toolbox",
        .maker = "ROS / ros2_control",
        .name = "control_toolbox::Pid",
        .form = Form::parallel,
        .law = "u = p e + (i/s) e + d s (c r - y), e = r - y",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "p", .label = "p", .role = ParameterRole::gain, .term = kKp},
                {.name = "i", .label = "i", .unit = "1/s", .role = ParameterRole::integral, .term = kKi},
                {.name = "d", .label = "d", .unit = "s", .role = ParameterRole::derivative, .term = kKd},
                {.name = "i_clamp",
                 .label = "i_clamp, i_clamp_min, i_clamp_max",
                 .unit = "output",
                 .role = ParameterRole::limit,
                 .term = {.Su = 1},
                 .range = {0, kUnbounded},
                 .zero_remark = "With i_clamp 0, the default of ROS 1, there is no integral action.",
                 .remark = "It must be set: with 0, the default of ROS 1, there is no integral action."},
                {.name = "error_dot",
                 .label = "error_dot",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = std::string("of the error"), .c = 1},
                             {.value = std::string("of the measurement"), .c = 0}},
                 .elsewhere = true,
                 .remark = "A program may pass its own derivative, filtered or not."},
            },
        .filter = {FilterKind::none, 0, "None; a program may pass a filtered error_dot."},
        .weights = {1, 1, "A program that passes the derivative of the measurement as error_dot has c = 0."},
        .action = {.kind = Action::Kind::signed_gain,
                   .text = "Negative gains give direct action; the old updatePid inverts the sign."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "i_clamp; in ROS 2 also back-calculation or conditional integration, and u_clamp",
                      .sample_time_text = "the caller's dt"},
        .traps = {"ROS 1: i_clamp is 0 by default, which keeps the integral at 0.",
                  "An old revision copies p into i and d when dynamic_reconfigure is refreshed."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"computeCommand and updatePid", "compute_command of ROS 2",
                              "equations of the anti-windup"},
                     .sources = {"ros-controls/control_toolbox src/pid.cpp, control_toolbox/src/pid.cpp",
                                 "control.ros.org and docs.ros.org, class Pid"}},
        .example = of_design_a(
            {{"p", 1.5}, {"i", 0.0125}, {"d", 30.0}, {"i_clamp", 100.0}, {"error_dot", std::string("of the error")}}),
        .snippets = {{"YAML, in the parameters of pid_controller",
                      "gains:\n"
                      "  joint:\n"
                      "    p: {p}\n"
                      "    i: {i}\n"
                      "    d: {d}\n"
                      "    i_clamp_max: {i_clamp}\n"
                      "    i_clamp_min: -{i_clamp}"}},
    };
}

// A transfer function with the variable s: neither package has a constructor of PID controllers.
Product transfer_function() {
    const auto part = [](std::string_view name, std::string_view unit, ParameterRole role, Term term) {
        return Parameter{.name = name, .label = name, .unit = unit, .role = role, .term = term};
    };
    return {
        .form = Form::parallel,
        .law = "C = Kp + Ki/s + Kd s/(Tf s + 1)",
        .gain_basis = "engineering units",
        .parameters = {part("Kp", "", ParameterRole::gain, kKp), part("Ki", "1/s", ParameterRole::integral, kKi),
                       part("Kd", "s", ParameterRole::derivative, kKd), part("Tf", "s", ParameterRole::filter, kTf)},
        .filter = {FilterKind::parameter, 0, "First order, written into the transfer function."},
        .weights = {1, 1, "One input, the error."},
        .action = kSigned,
        .algorithm = {.text = "a transfer function in continuous time", .sample_time_text = "none"},
        .traps = {"Without Tf the transfer function is improper; a simulation needs a filter.",
                  "A Ki of 0 leaves a pole at 0 that a zero cancels."},
        .example = of_design_a({{"Kp", 1.5}, {"Ki", 0.0125}, {"Kd", 30.0}, {"Tf", 2.0}}),
    };
}

Product python_control() {
    Product product = transfer_function();
    product.id = "python_control";
    product.maker = "python-control";
    product.name = "python-control transfer function";
    product.families = {"Python Control Systems Library"};
    product.evidence = {.level = EvidenceLevel::read,
                        .read = {"tf('s') and tf(num, den)"},
                        .sources = {"python-control.readthedocs.io 0.10.1, control.tf"}};
    product.snippets = {{"Python",
                         "import control as ct\n"
                         "\n"
                         "s = ct.tf('s')\n"
                         "C = {Kp} + {Ki|0}/s + {Kd|0}*s/({Tf|0}*s + 1)"}};
    return product;
}

Product octave_control() {
    Product product = transfer_function();
    product.id = "octave_control";
    product.maker = "GNU Octave";
    product.name = "Octave package control, transfer function";
    product.families = {"Octave"};
    product.traps.push_back(
        "optiPIDctrl of the package has a second-order filter of the whole controller, 1/(tau s + 1)^2.");
    product.evidence = {.level = EvidenceLevel::read,
                        .read = {"tf(\"s\")", "optiPIDctrl"},
                        .sources = {"gnu-octave/pkg-control inst/@tf/tf.m at 05cf9487, inst/optiPIDctrl.m"}};
    product.snippets = {{"Octave",
                         "pkg load control\n"
                         "\n"
                         "s = tf(\"s\");\n"
                         "C = {Kp} + {Ki|0}/s + {Kd|0}*s/({Tf|0}*s + 1);"}};
    return product;
}

}  // namespace

std::vector<Product> library_products() {
    return {simple_pid(), control_systems(), discrete_pids(), lim_pid(), ros(), python_control(), octave_control()};
}

}  // namespace tunewright::product
