#include "engine/evaluation/evaluation_start.h"

#include <cmath>
#include <string>

#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

/// Error of an Npid that is wrong for every plant.
std::optional<Error> check_npid(const Controller& controller) {
    const auto* npid = std::get_if<Npid>(&controller);
    if (npid == nullptr) return std::nullopt;
    const auto invalid = [](const char* field, const std::string& message) {
        return Error{ErrorKind::invalid_argument, std::string("controller/") + field, message};
    };
    if (!(npid->Ti > 0 && std::isfinite(npid->Ti)))
        return invalid("Ti", "Ti is " + text(npid->Ti) +
                                 "; the nonlinear form needs a finite Ti > 0. Without integral action, use the form "
                                 "ideal.");
    if (npid->delta_r && !(*npid->delta_r > 0 && std::isfinite(*npid->delta_r)))
        return invalid("delta_r", "delta_r is " + text(*npid->delta_r) +
                                      "; it must be a finite number > 0. Omit it to use the size of the set-point "
                                      "step.");
    if (npid->filter.type != FilterType::none && npid->filter.type != FilterType::derivative)
        return invalid("filter", "The nonlinear form needs the filter none or derivative.");
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

Equivalents equivalents_of(const Controller& controller) {
    Equivalents equivalents;
    equivalents.parallel = gains(controller);
    // A series controller stays as it is: a conversion through the ideal form would change b.
    if (const auto* series = std::get_if<SeriesPid>(&controller)) {
        equivalents.series = *series;
        return equivalents;
    }
    const auto ideal = to_ideal(controller);
    if (!ideal) {
        equivalents.why_no_series = ideal.error().message;
        return equivalents;
    }
    if (auto series = to_series(*ideal))
        equivalents.series = *series;
    else
        equivalents.why_no_series = series.error().message;
    return equivalents;
}

}  // namespace

std::optional<Error> refuse_traces(const EvaluateOptions& options, std::size_t controllers) {
    constexpr std::size_t max = 100'000;  // gives an answer of some ten megabytes
    if (options.points <= 0 || static_cast<std::size_t>(options.points) * controllers <= max) return std::nullopt;
    return Error{ErrorKind::invalid_argument, "evaluate/points",
                 "points is " + std::to_string(options.points) + " for each of " + std::to_string(controllers) +
                     " controllers; an answer can have at most " + std::to_string(max) + " in total. Give at most " +
                     std::to_string(max / controllers) + ", or ask for fewer controllers."};
}

std::optional<Error> refuse_evaluation(const Controller& controller, const EvaluateOptions& options) {
    if (auto error = check_options(options)) return error;
    return check_npid(controller);
}

std::optional<Error> stopped(const EvaluateOptions& options) {
    if (!options.stop.stop_requested()) return std::nullopt;
    return Error{ErrorKind::cancelled, "", "The evaluation was stopped."};
}

Controller resolved(Controller controller, const EvaluateOptions& options) {
    if (auto* npid = std::get_if<Npid>(&controller); npid != nullptr && !npid->delta_r)
        npid->delta_r = std::abs(options.setpoint_step);
    if (auto* series = std::get_if<SeriesPid>(&controller)) series->b_equivalent = b_equivalent(*series);
    return controller;
}

Evaluation begun(const Controller& controller, const EvaluateOptions& options) {
    Evaluation evaluation;
    evaluation.controller = resolved(controller, options);
    evaluation.equivalents = equivalents_of(evaluation.controller);
    return evaluation;
}

Error of_controller(Error error) {
    if (error.where.empty()) error.where = "controller";
    return error;
}

void mark_unstable(Evaluation& evaluation, const StabilityCount& count) {
    evaluation.robustness = unstable_robustness(count);
    evaluation.performance = no_performance("The closed loop is not stable.");
    evaluation.warnings.push_back(
        {"unstable-loop", "This controller does not stabilise the plant" +
                              (count.unstable_poles > 0 ? " (" + std::to_string(count.unstable_poles) +
                                                              " closed-loop poles in the right half-plane)"
                                                        : std::string()) +
                              "; do not use it."});
}

void warn_of_limit(Evaluation& evaluation, const std::string& step) {
    evaluation.warnings.push_back(
        {"actuator-limited", "The controller's output reaches its limit after the " + step +
                                 " step; Ms, Mt and the margins hold for the loop without limits."});
}

void warn_of_no_rest(Evaluation& evaluation) {
    evaluation.warnings.push_back(
        {"does-not-settle", "The response does not settle within the simulated time; figures that need it are empty."});
}

}  // namespace tunewright
