#include "engine/check/pace/given_law.h"

#include <cmath>
#include <limits>
#include <string>

#include "engine/check/service.h"
#include "engine/check/thresholds.h"
#include "engine/number_text.h"

namespace tunewright::check {
namespace {

constexpr double kMaxDifference = 0.25;  // relative, of gain and of Ti
constexpr double kStandardErrors = 3;

/// True if `fitted` is off by more than chance and more than kMaxDifference. Both infinite: equal.
bool differs(double fitted, double given, double relative_error) {
    const double difference = std::abs(fitted / given - 1);
    return difference > kMaxDifference && difference > kStandardErrors * relative_error;
}

std::string settings_text(const LoopLaw& law, const UnitNames& units) {
    return "a gain of " + figure_text(law.gain) +
           (std::isfinite(law.Ti) ? " and Ti " + units.time_text(law.Ti) : " and no integral action");
}

}  // namespace

ChosenLaw chosen_law(const LoopQuestion& question, const Samples& samples, const OutputRange& u_range,
                     const UnitNames& units) {
    const LoopLaw fitted = loop_law(samples.error(), samples.u, samples.step);
    if (!question.controller || question.controller->Kp == 0) return {fitted, {}};
    const ParallelPid& pid = *question.controller;
    const LoopLaw given{.gain = pid.Kp,
                        .Ti = pid.Ki != 0 ? pid.Kp / pid.Ki : std::numeric_limits<double>::infinity(),
                        .explained = 1,
                        .given = true};
    const auto [at_low, at_high] = limit_shares(samples, u_range);
    const bool comparable = pid.Kd == 0 && fitted.explained >= kKnownLaw && at_low + at_high < kSaturatedShare;
    if (!comparable ||
        (!differs(fitted.gain, given.gain, fitted.gain_error) && !differs(fitted.Ti, given.Ti, fitted.Ti_error)))
        return {given, {}};
    return {fitted, Warning{"controller-differs",
                            "The given settings have " + settings_text(given, units) + ", but the record shows " +
                                settings_text(fitted, units) +
                                ". The check uses those of the record. Compare units, form and time of the settings."}};
}

}  // namespace tunewright::check
