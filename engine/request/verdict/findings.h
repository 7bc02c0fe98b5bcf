// One entry of an answer as its findings look at it, and all findings: each a function of its figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/request/verdict/thresholds.h"
#include "engine/request/verdict/verdict.h"

namespace tunewright::verdict {

/// What a design was asked to keep; empty: nothing.
struct RequestedLimits {
    std::optional<double> Ms, Mt, Mks;
};

/// The loop of which a peak is known: the ideal one, that of the user's controller, or either on the worst of several
/// plants.
enum class PeakLoop { ideal, on_device, worst_plant, ideal_on_worst_plant };

struct PlacedPeak {
    double value = 0;
    PeakLoop loop = PeakLoop::ideal;
    bool on_worst_plant() const { return loop == PeakLoop::worst_plant || loop == PeakLoop::ideal_on_worst_plant; }
};

/// What follows the figure in a sentence: "" or " on the worst plant".
std::string words_of(PeakLoop loop);

/// An entry that has an evaluation.
struct VerdictInput {
    const TuningEntry& entry;
    const TuningEntry* today;  ///< of the settings in use, with an evaluation, if it is another entry; else null
    const Context& context;
    const Evaluation& evaluation = *entry.evaluation;

    /// What runs is judged: the loop as it is built, where that is known.
    const Robustness& robustness() const;
    const Performance& performance() const;
    bool on_device() const { return entry.on_device.has_value(); }
    bool is_today() const { return entry.method == "baseline"; }

    bool has_integral() const;
    bool warned_of(const std::string& code) const;
    RequestedLimits limits() const;
    /// The larger of the loop that runs and of the worst of several plants (which is known of the ideal loop alone).
    std::optional<PlacedPeak> worst_Ms() const;
    std::optional<PlacedPeak> worst_Mt() const;
};

/// The loop of an entry that runs; null where there is none.
const Performance& performance_of(const TuningEntry& entry);

// primary_findings.cpp: what the loop is

/// All that apply, the most severe first; at least one. `good` only where every plant that the answer knows of and the
/// loop as it is built are stable and settle, with Ms at most 1.7 and within its limit.
std::vector<Finding> primary_findings(const VerdictInput& c);

/// "Ms = 1.40 at 0.21 rad/s", "Mks = 12.0 %/degC": a limit that the design touches, and on which loop.
struct ActiveLimit {
    std::string name;
    double value = 0;
    std::optional<double> omega;
    std::string where;
};
std::vector<ActiveLimit> active_limits(const VerdictInput& c);

// What else follows of a loop that is stable; empty where there is nothing to say.

using OptionalFinding = std::optional<Finding>;

// margins.cpp
OptionalFinding on_device(const VerdictInput& c);          ///< the loop as it is built beside the ideal one
OptionalFinding active_limit(const VerdictInput& c);       ///< which limit stops the design, and where; else the peaks
OptionalFinding all_members(const VerdictInput& c);        ///< the worst of several plants
OptionalFinding margins(const VerdictInput& c);            ///< what may change before the loop oscillates
OptionalFinding nonlinear_margins(const VerdictInput& c);  ///< what margins mean where plant or controller is nonlinear
OptionalFinding large_errors(
    const VerdictInput& c);  ///< whether the nonlinear integral lets errors of every size die out

// responses.cpp
OptionalFinding load_error(const VerdictInput& c);  ///< IAE of the load step, against today's
OptionalFinding overshoot(const VerdictInput& c);   ///< of a set-point step, what was asked for, and what keeps it
std::optional<Level> overshoot_level(
    const VerdictInput& c);                       ///< of that finding, known without the search for what keeps it
OptionalFinding movement(const VerdictInput& c);  ///< of u, against today's

// replayed.cpp
OptionalFinding replayed(const VerdictInput& c);  ///< the recorded time with this controller

// actuator.cpp
/// Steps for which u has to be beyond its limits at rest, whatever the controller.
struct StepsBeyondActuator {
    bool setpoint = false, load = false;
};
StepsBeyondActuator steps_beyond_actuator(const VerdictInput& c);

/// u rests at its limit: the steps that it carries. A note where the request names the size of none of those that it
/// does not.
OptionalFinding actuator_too_small(const VerdictInput& c);
OptionalFinding at_its_limits(const VerdictInput& c);  ///< u reaches the actuator's ends

// causes.cpp
OptionalFinding PI_or_PID(const VerdictInput& c);
OptionalFinding excess(const VerdictInput& c);  ///< over the least IAE at the same Ms
OptionalFinding dead_time_rules(const VerdictInput& c);
OptionalFinding filter_rules(const VerdictInput& c);
OptionalFinding sample_time(const VerdictInput& c);
OptionalFinding noise(const VerdictInput& c);

/// "about a quarter of", "about the same as", "2.4 times"; the ratio goes into the figures.
void say_ratio(FindingBuilder& draft, double ratio);

}  // namespace tunewright::verdict
