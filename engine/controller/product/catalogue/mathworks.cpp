// MathWorks: pidstd, pid, pidstd2 and pid2 of MATLAB, the blocks of Simulink.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kDefaultPole = 100;  // rad/s

Parameter plain(std::string_view name, std::string_view unit, ParameterRole role, Term term) {
    return {.name = name, .label = name, .unit = unit, .role = role, .term = term};
}
Parameter time_of(std::string_view name, ParameterRole role, Term term) {
    return {.name = name, .label = name, .unit = "s", .role = role, .term = term, .range = {0, kUnbounded}};
}
Parameter weight_elsewhere(std::string_view name, ParameterRole role, std::string_view remark) {
    return {.name = name,
            .label = name,
            .role = role,
            .shape = Shape::weight,
            .standard = 1.0,
            .elsewhere = true,
            .remark = remark};
}

Algorithm forward_euler(std::string_view text, std::string_view anti_windup) {
    return {.integral = IntegralRule::forward,
            .derivative = DerivativeRule::filtered_forward,
            .text = text,
            .anti_windup = anti_windup,
            .sample_time_text = "Ts"};
}

Product pidstd() {
    return {
        .id = "matlab_pidstd",
        .maker = "MathWorks",
        .name = "MATLAB pidstd",
        .form = Form::ideal,
        .law = "C = Kp [ 1 + 1/(Ti s) + Td s/((Td/N) s + 1) ]",
        .gain_basis = "engineering units",
        .parameters = {plain("Kp", "", ParameterRole::gain, kKp),
                       time_of("Ti", ParameterRole::integral, kTi),
                       time_of("Td", ParameterRole::derivative, kTd),
                       {.name = "N",
                        .label = "N",
                        .role = ParameterRole::filter,
                        .term = kFilterGain,
                        .range = {0, kUnbounded},
                        .remark = "a ratio, Td/Tf"},
                       weight_elsewhere("b", ParameterRole::weight_b, "only in pidstd2"),
                       weight_elsewhere("c", ParameterRole::weight_c, "only in pidstd2")},
        .filter = {FilterKind::parameter, 0, "First order, Td/N."},
        .weights = {1, 1, "pidstd has one input, the error; pidstd2 has b and c."},
        .action = kSigned,
        .algorithm = forward_euler("a transfer function; forward Euler in I and D by default", ""),
        .traps = {"N is a ratio here."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"formula", "default integrator formulas"},
                     .sources = {"mathworks.com control/ref/pidstd, pidstddata"}},
        .example = of_design_a({{"Kp", 1.5}, {"Ti", 120.0}, {"Td", 20.0}, {"N", 10.0}}),
        .snippets = {{"MATLAB", "C = pidstd({Kp}, {Ti}, {Td}, {N|Inf});"}},
    };
}

Product pid() {
    return {
        .id = "matlab_pid",
        .maker = "MathWorks",
        .name = "MATLAB pid",
        .form = Form::parallel,
        .law = "C = Kp + Ki/s + Kd s/(Tf s + 1)",
        .gain_basis = "engineering units",
        .parameters = {plain("Kp", "", ParameterRole::gain, kKp), plain("Ki", "1/s", ParameterRole::integral, kKi),
                       plain("Kd", "s", ParameterRole::derivative, kKd), time_of("Tf", ParameterRole::filter, kTf),
                       weight_elsewhere("b", ParameterRole::weight_b, "only in pid2"),
                       weight_elsewhere("c", ParameterRole::weight_c, "only in pid2")},
        .filter = {FilterKind::parameter, 0, "First order, Tf; forward Euler needs Tf > Ts/2."},
        .weights = {1, 1, "pid has one input, the error; pid2 has b and c."},
        .action = kSigned,
        .algorithm = forward_euler("a transfer function; forward Euler in I and D by default", ""),
        .traps = {"It is discretised by forward Euler by default."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"formula, defaults", "Tf > Ts/2"},
                     .sources = {"mathworks.com control/ref/pid"}},
        .example = of_design_a({{"Kp", 1.5}, {"Ki", 0.0125}, {"Kd", 30.0}, {"Tf", 2.0}}),
        .snippets = {{"MATLAB", "C = pid({Kp}, {Ki}, {Kd}, {Tf|0});"}},
    };
}

/// The same law with two inputs, r and y.
Product two_inputs(Product product, std::string_view id, std::string_view name, std::string_view law,
                   std::string_view page) {
    product.id = id;
    product.name = name;
    product.law = law;
    for (Parameter& parameter : product.parameters) {
        if (!parameter.elsewhere) continue;
        parameter.elsewhere = false;
        parameter.remark = "";
    }
    product.weights.text = "b and c can have any value.";
    product.evidence = {.level = EvidenceLevel::read, .read = {"formula, defaults"}, .sources = {page}};
    product.example.settings.push_back({"b", 0.6});
    product.example.settings.push_back({"c", 0.0});
    return product;
}

Product pidstd2() {
    Product product = two_inputs(pidstd(), "matlab_pidstd2", "MATLAB pidstd2",
                                 "u = Kp [ (b r - y) + (1/(Ti s)) (r - y) + (Td s/((Td/N) s + 1)) (c r - y) ]",
                                 "mathworks.com control/ref/pidstd2");
    product.snippets = {{"MATLAB", "C = pidstd2({Kp}, {Ti}, {Td}, {N|Inf}, {b}, {c});"}};
    return product;
}

Product pid2() {
    Product product = two_inputs(pid(), "matlab_pid2", "MATLAB pid2",
                                 "u = Kp (b r - y) + (Ki/s) (r - y) + (Kd s/(Tf s + 1)) (c r - y)",
                                 "mathworks.com control/ref/pid2, piddata2");
    product.snippets = {{"MATLAB", "C = pid2({Kp}, {Ki}, {Kd}, {Tf|0}, {b}, {c});"}};
    return product;
}

Parameter pole() {
    return {.name = "N",
            .label = "N",
            .unit = "rad/s",
            .role = ParameterRole::filter,
            .term = {.Tf = -1},
            .range = {0, kUnbounded},
            .standard = kDefaultPole,
            .remark = "the filter's pole, 1/Tf"};
}

Evidence block_evidence() {
    return {.level = EvidenceLevel::partly,
            .read = {"structure, forms, order of the filter"},
            .unverified = {"formula with N and its default 100 (a picture)"},
            .sources = {"mathworks.com simulink/slref/pidcontroller R2021a"}};
}

Algorithm block_algorithm() {
    return forward_euler("position algorithm; forward Euler by default, other rules can be chosen",
                         "none, back-calculation or clamping");
}

GainScheduling block_scheduling(std::optional<Interpolation> between, std::string_view text) {
    return {.between = between, .text = text, .source = "mathworks.com slcontrol/ug/pidgainscheduler"};
}

constexpr std::string_view kPoleFilter = "First order with its pole at N rad/s; forward Euler needs N Ts < 2.";

Product block_parallel() {
    return {
        .id = "simulink_pid_parallel",
        .maker = "MathWorks",
        .name = "Simulink PID Controller block, form Parallel",
        .form = Form::parallel,
        .law = "u = P (b r - y) + (I/s) (r - y) + (D N/(1 + N/s)) (c r - y)",
        .gain_basis = "engineering units",
        .parameters = {plain("P", "", ParameterRole::gain, kKp),
                       plain("I", "1/s", ParameterRole::integral, kKi),
                       plain("D", "s", ParameterRole::derivative, kKd),
                       pole(),
                       fixed_choice("Form", "Form", std::string("Parallel")),
                       {.name = "block",
                        .label = "block",
                        .role = ParameterRole::choice,
                        .shape = Shape::option,
                        .options = {{.value = std::string("PID Controller"), .b = 1, .c = 1},
                                    {.value = std::string("PID Controller (2DOF)"), .free_weights = true}}},
                       {.name = "b",
                        .label = "b (2DOF block)",
                        .role = ParameterRole::weight_b,
                        .shape = Shape::weight,
                        .standard = 1.0},
                       {.name = "c",
                        .label = "c (2DOF block)",
                        .role = ParameterRole::weight_c,
                        .shape = Shape::weight,
                        .standard = 1.0}},
        .filter = {FilterKind::parameter, 0, kPoleFilter},
        .weights = {1, 1, "b and c are those of the block with two degrees of freedom."},
        .action = kSigned,
        .algorithm = block_algorithm(),
        .traps = {"N is a pole in rad/s here, a ratio in pidstd, and a time in the autotuner block's parallel form."},
        .evidence = block_evidence(),
        .example = of_design_a({{"P", 1.5},
                                {"I", 0.0125},
                                {"D", 30.0},
                                {"N", 0.5},
                                {"Form", std::string("Parallel")},
                                {"block", std::string("PID Controller (2DOF)")},
                                {"b", 0.6},
                                {"c", 0.0}}),
        .scheduling = block_scheduling(
            {},
            "The PID Gain Scheduler block reads P, I and D from tables over the scheduling variable, linear between "
            "the breakpoints; the PID block takes them as external inputs."),
        .snippets = {{"MATLAB, for the block in variable block",
                      "set_param(block, 'Controller', 'PID', 'Form', '{Form}', 'P', '{P}', 'I', '{I}', 'D', '{D}', "
                      "'N', '{N}');\n"
                      "set_param(block, 'b', '{b}', 'c', '{c}');"}},
    };
}

Product block_ideal() {
    return {
        .id = "simulink_pid_ideal",
        .maker = "MathWorks",
        .name = "Simulink PID Controller block, form Ideal",
        .form = Form::ideal,
        .law = "u = P [ 1 + I/s + D N/(1 + N/s) ] (r - y)",
        .gain_basis = "engineering units",
        .parameters = {plain("P", "", ParameterRole::gain, kKp),
                       {.name = "I",
                        .label = "I",
                        .unit = "1/s",
                        .role = ParameterRole::integral,
                        .term = {.Ti = -1},
                        .range = {0, kUnbounded},
                        .remark = "1/Ti, not Ti"},
                       time_of("D", ParameterRole::derivative, kTd),
                       pole(),
                       fixed_choice("Form", "Form", std::string("Ideal")),
                       weight_elsewhere("b", ParameterRole::weight_b, "only in the 2DOF block"),
                       weight_elsewhere("c", ParameterRole::weight_c, "only in the 2DOF block")},
        .filter = {FilterKind::parameter, 0, kPoleFilter},
        .weights = {1, 1, "The block with one degree of freedom acts on the error; the 2DOF block has b and c."},
        .action = kSigned,
        .algorithm = block_algorithm(),
        .traps = {"I is 1/Ti, not Ti."},
        .evidence = block_evidence(),
        .example =
            of_design_a({{"P", 1.5}, {"I", 0.00833333}, {"D", 20.0}, {"N", 0.5}, {"Form", std::string("Ideal")}}),
        .scheduling = block_scheduling(
            Interpolation::linear_in_gains,
            "The PID Gain Scheduler block reads P, I and D from tables over the scheduling variable, linear between "
            "the breakpoints; I is 1/Ti here. The PID block takes them as external inputs."),
        .snippets = {{"MATLAB, for the block in variable block",
                      "set_param(block, 'Controller', 'PID', 'Form', '{Form}', 'P', '{P}', 'I', '{I}', 'D', '{D}', "
                      "'N', '{N}');"}},
    };
}

Product autotuner() {
    return {
        .id = "simulink_pid_autotuner_block",
        .maker = "MathWorks",
        .name = "Simulink Closed-Loop PID Autotuner block, form Ideal",
        .form = Form::ideal,
        .law = "C = P [ 1 + 1/(I s) + D s/((D/N) s + 1) ]",
        .gain_basis = "engineering units",
        .parameters = {plain("P", "", ParameterRole::gain, kKp),
                       time_of("I", ParameterRole::integral, kTi),
                       time_of("D", ParameterRole::derivative, kTd),
                       {.name = "N",
                        .label = "N",
                        .role = ParameterRole::filter,
                        .term = kFilterGain,
                        .range = {0, kUnbounded},
                        .remark = "a ratio; in its parallel form the filter's time"},
                       fixed_choice("Form", "Form", std::string("Ideal"))},
        .filter = {FilterKind::parameter, 0, "First order, D/N."},
        .weights = {1, 1, "It acts on the error."},
        .action = kSigned,
        .algorithm = {.text = "the rules of I and D are chosen", .sample_time_text = "of the block"},
        .traps = {"The letters of the PID Controller block mean something else here."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"both formulas"},
                     .sources = {"Simulink Control Design reference pp. 2560, 2718"}},
        .example = of_design_a({{"P", 1.5}, {"I", 120.0}, {"D", 20.0}, {"N", 10.0}, {"Form", std::string("Ideal")}}),
    };
}

}  // namespace

std::vector<Product> mathworks_products() {
    return {pidstd(), pid(), pidstd2(), pid2(), block_parallel(), block_ideal(), autotuner()};
}

}  // namespace tunewright::product
