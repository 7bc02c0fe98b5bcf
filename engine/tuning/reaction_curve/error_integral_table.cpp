#include "engine/tuning/reaction_curve/error_integral_table.h"

#include <cmath>

namespace tunewright {

Pid error_integral_settings(const ErrorIntegralRow& row, IntegralLaw law, const ReducedModel& model) {
    const double q = model.L / model.T1;
    Pid pid{.Kp = row.a1 * std::pow(q, row.b1) / model.K};
    if (row.a2 != 0)
        pid.Ti = model.T1 * (law == IntegralLaw::power ? std::pow(q, row.b2) / row.a2 : 1 / (row.a2 + row.b2 * q));
    if (row.a3 != 0) pid.Td = model.T1 * row.a3 * std::pow(q, row.b3);
    return pid;
}

OptionDescription criterion_option(std::vector<std::string> choices) {
    OptionDescription option;
    option.name = "criterion";
    option.type = OptionType::choice;
    option.sentence = "The error integral whose optima the settings were fitted to.";
    option.default_value = choices.front();
    option.choices = std::move(choices);
    return option;
}

}  // namespace tunewright
