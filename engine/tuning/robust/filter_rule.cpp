#include "engine/tuning/robust/filter_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/number_text.h"
#include "engine/tuning/limits.h"

namespace tunewright::robust {
namespace {

constexpr double kMinResidence = 0.1;  // of the shortest lag, if leads exceed the lags

/// The sum of the lags minus the leads, limited so that it does not vanish if leads cancel it; 0 without lags.
double filter_basis(const LinearPlant& plant) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const auto pole : plant.poles())
        if (pole.real() < 0) shortest = std::min(shortest, (-1.0 / pole).real());
    return std::isfinite(shortest) ? std::max(plant.lag_sum(), kMinResidence * shortest) : 0;
}

/// A plant with neither dead time nor lags has no natural filter time.
Error no_filter_time(const TuningProblem& problem) {
    const double L = problem.linear.dead_time();
    const std::string what =
        L > 0 ? "This plant has no lags, and its identified dead time of " + text(L) +
                    " is not significant because its standard error is " + text(problem.dead_time_std.value_or(0)) +
                    ". So there is no basis for a filter time. "
              : "This plant has neither dead time nor lags, so the speed of a PID is unbounded and there is no basis "
                "for a filter time. ";
    return {ErrorKind::unbounded_optimum, "filter",
            what + "Give the filter a time constant Tf, such as the sampling time or the time constant of the sensor."};
}

}  // namespace

Expected<std::optional<FilterRule>> explicit_filter(const RobustFilterOptions& options, bool pid) {
    if (options.Tf) return std::optional(FilterRule{.Tf = options.Tf, .Tf_over_Td = {}});
    if (!options.Tf_over_Td) return std::optional<FilterRule>();
    if (!pid)
        return Error{ErrorKind::invalid_argument, "filter/Tf_over_Td",
                     "A PI controller has no Td; give the filter as Tf."};
    return std::optional(FilterRule{.Tf = {}, .Tf_over_Td = options.Tf_over_Td});
}

Expected<FilterRule> filter_rule(const TuningProblem& problem, const RobustFilterOptions& options, bool pid) {
    const auto given = explicit_filter(options, pid);
    if (!given) return given.error();
    if (*given) return **given;
    if (!pid) return FilterRule{};
    const LinearPlant& plant = problem.linear;
    const bool dead_time = plant.dead_time() > problem.dead_time_std.value_or(0);
    if (dead_time || plant.has_right_half_plane_zero() || plant.pole_excess() >= 3)
        return FilterRule{.Tf = std::nullopt, .Tf_over_Td = limits::kDefaultTf_over_Td};
    const double basis = filter_basis(plant);
    if (basis > 0) return FilterRule{.Tf = 0.05 * basis, .Tf_over_Td = std::nullopt};
    return no_filter_time(problem);
}

double first_sign(const LinearPlant& plant) {
    const double sign = plant.low_frequency_gain() < 0 ? -1 : 1;
    return plant.unstable_poles() % 2 == 0 ? sign : -sign;
}

}  // namespace tunewright::robust
