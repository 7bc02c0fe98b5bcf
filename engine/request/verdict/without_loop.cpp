#include "engine/request/verdict/verdict.h"

#include <variant>

namespace tunewright::verdict {

std::vector<Finding> no_controller(const Error& error) {
    const bool limits = error.kind == ErrorKind::no_feasible_controller;
    return {Draft("no-controller", Level::bad)
                .say(limits ? "No controller meets these limits." : "This method has no answer here."),
            Draft("reason", Level::note).say(error.message)};
}

std::vector<Finding> without_loop(const Controller& controller, double Ku, const std::vector<Warning>& remarks) {
    Draft unknown("robustness-unknown", Level::warning);
    unknown.say(
        "How robust this loop is cannot be known from Ku and Pu alone: Ms, margins and responses need a model of the "
        "plant or a recorded test.");
    if (const auto* pid = std::get_if<IdealPid>(&controller))
        unknown.say(" Kp is ").number("Kp_over_Ku", pid->Kp / Ku).say(" of Ku, the gain at which the loop oscillates.");
    std::vector<Finding> verdict{unknown};
    for (const Warning& remark : remarks) verdict.push_back(Draft("reason", Level::note).say(remark.detail));
    return verdict;
}

std::vector<Finding> of_all_without_loop() {
    return {Draft("robustness-unknown", Level::warning)
                .say("Ku and Pu alone give settings and no figure of the loop. Record the test, or give a model of the "
                     "plant, to know which of them is robust.")};
}

}  // namespace tunewright::verdict
