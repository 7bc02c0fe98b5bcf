#include "engine/tuning/method/ultimate_rule.h"

#include "engine/loop/margins.h"

namespace tunewright {
namespace {

Error wrong(const std::string& where, const std::string& sentence) {
    return {ErrorKind::invalid_argument, where, sentence};
}

Expected<UltimatePoint> given_by_hand(const UltimateOptions& options) {
    const auto &Ku = options.Ku, &Pu = options.Pu;
    if (!Pu) return wrong("Pu", "Ku is given without Pu; give both or neither.");
    if (!Ku) return wrong("Ku", "Pu is given without Ku; give both or neither.");
    if (*Ku == 0)
        return wrong(
            "Ku", "Ku is 0; it must be the gain at which the loop oscillates (negative for a plant of negative gain).");
    return UltimatePoint{*Ku, *Pu};
}

Error no_oscillation(const LinearPlant& plant) {
    const std::string reason =
        plant.unstable_poles() > 0
            ? "The plant is unstable, and no proportional gain stabilises it."
            : "No proportional gain makes this plant oscillate: its phase does not reach -180 degrees.";
    return {ErrorKind::unsupported, "plant",
            reason + " It has no ultimate point. Use a rule on a step-response model (simc, lambda), or robust."};
}

}  // namespace

OptionSet<UltimateOptions> ultimate_options() {
    OptionSet<UltimateOptions> set;
    set.choice(&UltimateOptions::ultimate, "ultimate",
               "Origin of Ku and Pu: model (computed from the plant, with the exact dead time) or relay (by the "
               "describing function of a recorded relay test).",
               Words<UltimateSource>{{"model", UltimateSource::model}, {"relay", UltimateSource::relay}});
    set.field(&UltimateOptions::Ku, "Ku",
              "Given ultimate gain, with Pu: the proportional gain at which the loop oscillates.", {.unit = "u/y"});
    set.field(&UltimateOptions::Pu, "Pu", "Period of that oscillation.", {.unit = "time", .exclusive_minimum = 0});
    return set;
}

Expected<UltimatePoint> chosen_ultimate_point(const TuningProblem& problem, const UltimateOptions& options) {
    // Integral action cannot control such a plant with any rule; the reason is that of the reduction.
    if (problem.linear.integrators() < 0) return reduce(problem.linear, {}).error();
    if (options.Ku || options.Pu) return given_by_hand(options);
    if (options.ultimate == UltimateSource::relay) {
        if (problem.relay_point) return *problem.relay_point;
        return wrong("ultimate",
                     "ultimate is relay, but there is no recorded relay test with a steady oscillation. Send one as "
                     "record, give Ku and Pu, or use those of the model.");
    }
    const auto point = ultimate_point(problem.linear);
    if (!point) return no_oscillation(problem.linear);
    return *point;
}

double gain_ratio(const LinearPlant& plant, const UltimatePoint& at) {
    return plant.integrators() > 0 ? 0 : 1 / (plant.low_frequency_gain() * at.Ku);
}

std::vector<Warning> ultimate_warnings(const TuningProblem& problem) {
    if (problem.linear.unstable_poles() == 0) return {};
    return {
        outside_validity("The plant is unstable: it also needs a minimal gain, which rules based on Ku ignore. "
                         "Check that the loop is stable, or use robust.")};
}

}  // namespace tunewright
