#include "engine/code/experiment/experiment.h"

#include <cmath>

#include "engine/code/algorithm.h"
#include "engine/code/experiment/bump_test.h"
#include "engine/code/experiment/relay_test.h"
#include "engine/number_text.h"

namespace tunewright::code {
namespace {

Error invalid(const char* where, const std::string& sentence) { return {ErrorKind::invalid_argument, where, sentence}; }

struct Size {
    const char* name;
    double value;
    bool zero_allowed;
};

std::optional<Error> size_fault(const Size& size) {
    if (std::isfinite(size.value) && (size.value > 0 || (size.zero_allowed && size.value == 0))) return std::nullopt;
    return invalid(size.name, std::string(size.name) + " is " + text(size.value) + "; it must be " +
                                  (size.zero_allowed ? ">= 0." : "above 0."));
}

std::optional<Error> range_fault(const char* low_name, const std::optional<double>& low, const char* high_name,
                                 const std::optional<double>& high) {
    for (const auto& [name, value] : {std::pair{low_name, low}, {high_name, high}})
        if (value && !(std::abs(*value) < kNoLimit))
            return invalid(name, std::string(name) + " is " + text(*value) + "; it must be a number within 1e30.");
    if (low && high && !(*low < *high))
        return invalid(high_name, std::string(high_name) + " is " + text(*high) + " and " + low_name + " " +
                                      text(*low) + "; " + high_name + " must be > " + low_name + ".");
    return std::nullopt;
}

std::optional<Error> fault_of(Experiment kind, const ExperimentOptions& o) {
    const bool relay = kind == Experiment::relay;
    for (const Size& size : {Size{"sample_time", o.Ts, false},
                             {"u_step", relay ? o.u_step : std::abs(o.u_step), false},
                             {"rate_limit", o.rate_limit, true},
                             {"quiet_time", o.quiet_time, true},
                             {"max_time", o.max_time, true},
                             {"hysteresis", o.hysteresis, true},
                             {"frozen_time", o.frozen_time, true},
                             {"y_move", o.y_move, true}})
        if (auto fault = size_fault(size)) return fault;
    if (!(std::abs(o.asymmetry) <= kLargestAsymmetry))
        return invalid("asymmetry", "asymmetry is " + text(o.asymmetry) + "; it must be -0.8 to 0.8.");
    if (o.cycles < 0 || o.cycles > kMostCycles)
        return invalid("cycles", "cycles is " + std::to_string(o.cycles) + "; it must be 0 to " +
                                     std::to_string(kMostCycles) + ".");
    if (o.quiet_time > 0 && o.max_time > 0 && !(o.quiet_time < o.max_time))
        return invalid("max_time", "max_time is " + text(o.max_time) + " and quiet_time " + text(o.quiet_time) +
                                       "; max_time must be > quiet_time.");
    if (auto fault = range_fault("u_min", o.u_min, "u_max", o.u_max)) return fault;
    if (auto fault = range_fault("y_min", o.y_min, "y_max", o.y_max)) return fault;
    if (o.u_safe && !(*o.u_safe >= o.u_min.value_or(-kNoLimit) && *o.u_safe <= o.u_max.value_or(kNoLimit)))
        return invalid("u_safe", "u_safe is " + text(*o.u_safe) + "; it must be a number from u_min to u_max.");
    return std::nullopt;
}

}  // namespace

Expected<Program> experiment_algorithm(Experiment kind, const ExperimentOptions& options) {
    if (const auto fault = fault_of(kind, options)) return *fault;
    if (kind == Experiment::relay) return RelayTest(options).build();
    return BumpTest(options).build();
}

}  // namespace tunewright::code
