#include "engine/evaluation/evaluate_request.h"

#include <cmath>
#include <string>

#include "engine/number_text.h"

namespace tunewright {
namespace {

/// What no Npid may have.
std::optional<Error> check_npid(const Controller& controller) {
    const auto* npid = std::get_if<Npid>(&controller);
    if (npid == nullptr) return std::nullopt;
    const auto invalid = [](const char* field, const std::string& message) {
        return Error{ErrorKind::invalid_argument, std::string("controller/") + field, message};
    };
    if (!(npid->Ti > 0 && std::isfinite(npid->Ti)))
        return invalid("Ti", "Ti is " + text(npid->Ti) +
                                 "; the nonlinear form needs a finite Ti > 0. Without integral action it is the form "
                                 "ideal.");
    if (npid->delta_r && !(*npid->delta_r > 0 && std::isfinite(*npid->delta_r)))
        return invalid("delta_r", "delta_r is " + text(*npid->delta_r) +
                                      "; it must be a finite number > 0. Leave it out for the set-point step's size.");
    if (npid->filter.type != FilterType::none && npid->filter.type != FilterType::derivative)
        return invalid("filter", "The nonlinear form takes the filter none or derivative.");
    return std::nullopt;
}

std::optional<Error> check_options(const EvaluateOptions& o) {
    const auto invalid = [](const char* field, const std::string& message) {
        return Error{ErrorKind::invalid_argument, std::string("evaluate/") + field, message};
    };
    if (!std::isfinite(o.setpoint_step) || o.setpoint_step == 0)
        return invalid("setpoint_step", "setpoint_step must be a finite number that is not 0.");
    if (!std::isfinite(o.load_step) || o.load_step == 0)
        return invalid("load_step", "load_step must be a finite number that is not 0.");
    if (o.horizon && !(std::isfinite(*o.horizon) && *o.horizon > 0))
        return invalid("horizon", "horizon must be a time > 0 or \"auto\".");
    if (o.points != 0 && (o.points < 2 || o.points > 20000))
        return invalid("points", "points must be 0 or between 2 and 20000.");
    if (o.actuator && !(o.actuator->min < o.actuator->max && o.actuator->min <= 0 && o.actuator->max >= 0))
        return invalid("actuator",
                       "The limits are deviations from the operating point: min <= 0 <= max and min < max.");
    return std::nullopt;
}

}  // namespace

std::optional<Error> refuse_evaluation(const Controller& controller, const EvaluateOptions& options) {
    if (auto error = check_options(options)) return error;
    return check_npid(controller);
}

Controller resolved(Controller controller, const EvaluateOptions& options) {
    if (auto* npid = std::get_if<Npid>(&controller); npid != nullptr && !npid->delta_r)
        npid->delta_r = std::abs(options.setpoint_step);
    return controller;
}

}  // namespace tunewright
