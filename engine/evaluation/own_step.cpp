#include "engine/evaluation/own_step.h"

#include <cmath>
#include <limits>
#include <string>

#include "engine/number_text.h"

namespace tunewright {
namespace {

Error invalid(const std::string& field, const std::string& message) {
    return {ErrorKind::invalid_argument, "evaluate/own_step/" + field, message};
}

bool positive(const std::optional<double>& value) { return !value || (std::isfinite(*value) && *value > 0); }

std::optional<Error> refuse_load(const OwnStep::Load& load) {
    if (!std::isfinite(load.size) || load.size == 0)
        return invalid("load/size", "size is " + text(load.size) + "; it must be a finite number that is not 0.");
    if (!positive(load.duration))
        return invalid("load/duration", "duration is " + text(*load.duration) + "; it must be > 0.");
    if (load.shape != LoadShape::step && !load.duration)
        return invalid("load/duration", std::string("duration is missing; a ") +
                                            (load.shape == LoadShape::pulse ? "pulse" : "ramp") +
                                            " needs its length in time.");
    return std::nullopt;
}

}  // namespace

std::optional<Error> refuse_own_step(const OwnStep& s) {
    for (const auto& [name, value] : {std::pair("y", s.y), std::pair("u", s.u), std::pair("target", s.target)})
        if (!std::isfinite(value)) return invalid(name, std::string(name) + " must be a finite number.");
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double low = s.u_min.value_or(-kInfinity), high = s.u_max.value_or(kInfinity);
    if (!(low < high))
        return invalid("u_max", "u_max is " + text(high) + " and u_min " + text(low) + "; u_max must be > u_min.");
    if (!(s.u >= low && s.u <= high))
        return invalid("u", "u is " + text(s.u) + ", outside its limits " + (s.u_min ? text(low) : "-infinity") +
                                " to " + (s.u_max ? text(high) : "infinity") + ". Give the controller output at rest.");
    if (!positive(s.ramp_rate))
        return invalid("ramp_rate",
                       "ramp_rate is " + text(*s.ramp_rate) + "; it must be > 0. Leave it out for a step.");
    if (!positive(s.length)) return invalid("length", "length is " + text(*s.length) + "; it must be > 0.");
    if (s.hold && !(std::isfinite(*s.hold) && *s.hold >= 0))
        return invalid("hold", "hold is " + text(*s.hold) + "; it must be >= 0.");
    if (s.load) return refuse_load(*s.load);
    if (s.target == s.y)
        return invalid("target", "target is y, " + text(s.y) +
                                     ", and there is no load: nothing moves. Give another "
                                     "target or a load.");
    return std::nullopt;
}

}  // namespace tunewright
