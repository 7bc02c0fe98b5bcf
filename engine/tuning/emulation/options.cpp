#include "engine/tuning/emulation/options.h"

#include "engine/tuning/method/rule.h"

namespace tunewright::emulation {
namespace {

OptionDescription of_type(OptionType type, const std::string& name, const std::string& sentence,
                          const std::string& unit = {}) {
    OptionDescription option;
    option.name = name;
    option.type = type;
    option.sentence = sentence;
    option.unit = unit;
    return option;
}

OptionDescription positive(const std::string& name, const std::string& sentence, const std::string& unit = {}) {
    OptionDescription option = of_type(OptionType::number, name, sentence, unit);
    option.exclusive_minimum = 0;
    return option;
}

OptionDescription at_least_zero(OptionDescription option) {
    option.minimum = 0;
    return option;
}

OptionDescription word(const std::string& name, const std::string& sentence, std::vector<std::string> choices) {
    OptionDescription option = of_type(OptionType::choice, name, sentence);
    option.default_value = choices.front();
    option.choices = std::move(choices);
    return option;
}

OptionDescription object(const std::string& name, const std::string& sentence, std::vector<OptionDescription> fields) {
    OptionDescription option = of_type(OptionType::object, name, sentence);
    option.fields = std::move(fields);
    return option;
}

OptionDescription list(const std::string& name, const std::string& sentence, OptionDescription element, int most) {
    OptionDescription option = of_type(OptionType::list, name, sentence);
    option.fields = {std::move(element)};
    option.most = most;
    return option;
}

OptionDescription target_option() {
    return object(
        "target",
        "The response that the nonlinear controller gives: gamma for relative degree 1, tau_cl and xi for 2, poles for "
        "any. Default: lags that sum to half the slowest time of the linearisation.",
        {positive("gamma", "gamma y' + y = set point.", "time"),
         positive("tau_cl", "tau_cl^2 y'' + 2 xi tau_cl y' + y = set point.", "time"),
         positive("xi", "Damping ratio. Default: 1."),
         list("poles", "As many as the relative degree, complex ones in conjugate pairs.",
              of_type(OptionType::complex, "pole", "A number or [re, im], in the open left half-plane.", "1/time"),
              20)});
}

OptionDescription scenarios_option() {
    OptionDescription step = of_type(OptionType::number, "setpoint_step", "From this plant's steady state.", "y");
    step.required = true;
    return list("scenarios",
                "Runs that J is averaged over. Default: one step that takes 5 % more of the input, or of its range.",
                object("scenario", "A run from t = 0.",
                       {step,
                        of_type(OptionType::numbers_by_name, "initial",
                                "States at t = 0 by name, absolute; the others are at their steady values."),
                        of_type(OptionType::numbers_by_name, "parameters",
                                "Other values of the plant's parameters by name: an uncertain plant is one more "
                                "scenario, known to its nonlinear controller.")}),
                20);
}

OptionDescription bounds_option() {
    OptionDescription Ti = of_type(OptionType::range, "Ti", "[low, high], above 0.", "time");
    Ti.exclusive_minimum = 0;
    return object("bounds", "Where the optimum is searched. Those left out come from bounds_from.",
                  {of_type(OptionType::range, "Kp", "[low, high], low < high for negative gains too.", "u/y"), Ti,
                   at_least_zero(of_type(OptionType::range, "Td", "[low, high], from 0.", "time"))});
}

OptionDescription bounds_from_option() {
    OptionDescription alpha = of_type(OptionType::range, "alpha",
                                      "Factors of the smallest and of the largest of their values, Kp by size (Eq. 3): "
                                      "at least 0 and below 1, and above 1. Default: [0.2, 5].");
    alpha.minimum = 0;
    OptionDescription hysteresis =
        at_least_zero(of_type(OptionType::number, "relay_hysteresis",
                              "Hysteresis of the simulated relay test. Default: 0 with a dead time, else a tenth of "
                              "what the relay moves y by in the long run.",
                              "y"));
    return object(
        "bounds_from", "The first level: which classical settings are tried beside, and how bounds follow from them.",
        {list("methods",
              "Ids of methods. imc works on the linearisation and on a model identified from a simulated step test, "
              "ziegler_nichols_ultimate on a simulated relay test or the linearisation's ultimate point, all others on "
              "the linearisation. Default: these two.",
              of_type(OptionType::text, "method", "Id of a method."), 20),
         alpha, positive("lambda", "Of imc. Default: the target's time constant.", "time"),
         of_type(OptionType::number, "test_step",
                 "Step of the input in that test, not 0. Default: 2 % of the input's range, or of its "
                 "nominal value.",
                 "u"),
         positive("relay_amplitude", "Of the relay test. Default: 5 % of them.", "u"), hysteresis});
}

}  // namespace

std::vector<OptionDescription> described_options() {
    OptionDescription Tf = of_type(OptionType::number_or_range, "Tf",
                                   "Filter time of a PID's derivative part, or [low, high] to choose it too (Remark "
                                   "5). Default: a tenth of the target's time.",
                                   "time");
    Tf.exclusive_minimum = 0;
    return {
        controller_option({"PI", "PID"}),
        target_option(),
        word("formulation",
             "full: the PID's own run on the plant (Eq. 2); remark6: its error taken from the nonlinear controller's "
             "run, u compared alone.",
             {"full", "remark6"}),
        scenarios_option(),
        positive("horizon",
                 "Where J's integral ends. Default: eight times the target's slowest time after the dead time.",
                 "time"),
        object("weights", "J = mean of int wy (y_nl - y)^2 + wu (u_nl - u)^2 dt.",
               {at_least_zero(of_type(OptionType::number, "wy",
                                      "Default: wu over the square of the linearisation's static gain.", "u^2/y^2")),
                at_least_zero(of_type(OptionType::number, "wu", "Default: 1."))}),
        bounds_option(),
        bounds_from_option(),
        Tf,
        word("derivative_on", "measurement: of y alone; error: of set point minus y, with the kick of its step.",
             {"measurement", "error"}),
    };
}

}  // namespace tunewright::emulation
