// The findings on one entry of an answer, each a function of its figures, and the input that they share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/request/verdict/thresholds.h"
#include "engine/request/verdict/verdict.h"

namespace tunewright::verdict {

/// The limits that were set for a design; empty: none.
struct RequestedLimits {
    std::optional<double> Ms, Mt, Mks;
};

/// The words after the figure in a sentence: "" or " on the worst plant".
std::string words_of(PeakLoop loop);

/// An entry that has an evaluation.
struct VerdictInput {
    const TuningEntry& entry;
    const TuningEntry* today;  ///< today's settings, if they have an evaluation and are another entry; else null
    const Context& context;
    const Evaluation& evaluation = *entry.evaluation;

    /// The implemented loop where it is known, else the ideal one.
    const Robustness& robustness() const;
    const Performance& performance() const;
    const std::optional<RegionFigures>& region() const { return region_of(entry); }
    bool on_device() const { return entry.on_device.has_value(); }
    bool is_today() const { return entry.is_baseline(); }

    bool has_integral() const;
    bool warned_of(const std::string& code) const;
    RequestedLimits limits() const;
    std::optional<PlacedPeak> worst_Ms() const { return tunewright::worst_Ms(entry); }
    std::optional<PlacedPeak> worst_Mt() const { return tunewright::worst_Mt(entry); }
};

/// Those of the implemented loop where it is known, else of the ideal one.
const Robustness& robustness_of(const TuningEntry& entry);
const Performance& performance_of(const TuningEntry& entry);

// primary_findings.cpp: statements on the whole loop

/// True: y of this plant stays bounded while u stays at a limit.
bool stays_bounded(const LinearPlant& plant);

/// All that apply, the most severe first; at least one. `good` only where every plant that the answer knows of and the
/// implemented loop are stable and settle, with Ms at most 1.7 and within its limit.
std::vector<Finding> primary_findings(const VerdictInput& c);

/// "Ms = 1.40 at 0.21 rad/s", "Mks = 12.0 %/degC": a limit that the design touches, and on which loop.
struct ActiveLimit {
    std::string name;
    double value = 0;
    std::optional<double> omega;
    std::string where;
};
std::vector<ActiveLimit> active_limits(const VerdictInput& c);

// Further findings on a stable loop; empty if they do not apply.

using OptionalFinding = std::optional<Finding>;

// margins.cpp
OptionalFinding on_device(const VerdictInput& c);     ///< the implemented loop against the ideal one
OptionalFinding active_limit(const VerdictInput& c);  ///< which limit stops the design, and where; else the peaks
OptionalFinding all_members(const VerdictInput& c);   ///< the worst of several plants
OptionalFinding margins(const VerdictInput& c);  ///< how much gain or dead time may grow before the loop oscillates
OptionalFinding nonlinear_margins(const VerdictInput& c);  ///< the meaning of margins in a nonlinear loop
OptionalFinding large_errors(const VerdictInput& c);       ///< the decay of large errors under the nonlinear integral

// responses.cpp
OptionalFinding load_error(const VerdictInput& c);            ///< IAE of the load step, compared with today's
OptionalFinding overshoot(const VerdictInput& c);             ///< overshoot after a set-point step, with its cure
std::optional<Level> overshoot_level(const VerdictInput& c);  ///< its level, without its cure
OptionalFinding movement(const VerdictInput& c);              ///< movement of u, compared with today's

// replayed.cpp
OptionalFinding replayed(const VerdictInput& c);  ///< the recorded time with this controller

// own_step.cpp
OptionalFinding own_step(const VerdictInput& c);  ///< the user's own step, and how long it saturates u

// actuator.cpp
/// Steps that would need a steady-state u beyond its limits, with any controller.
struct StepsBeyondActuator {
    bool setpoint = false, load = false;
};
StepsBeyondActuator steps_beyond_actuator(const VerdictInput& c);

/// u stays at its limit: reports the steps that are possible. A note if the request sets the size of none of the
/// others.
OptionalFinding actuator_too_small(const VerdictInput& c);
OptionalFinding at_its_limits(const VerdictInput& c);  ///< u reaches the actuator's limits

// causes.cpp
OptionalFinding PI_or_PID(const VerdictInput& c);
OptionalFinding excess(const VerdictInput& c);  ///< excess over the least IAE at the same Ms
OptionalFinding proved(const VerdictInput& c);  ///< how much better any controller could be, by a proof
OptionalFinding dead_time_rules(const VerdictInput& c);
OptionalFinding filter_rules(const VerdictInput& c);
OptionalFinding sample_time(const VerdictInput& c);
OptionalFinding noise(const VerdictInput& c);

/// "about a quarter of", "about the same as", "2.4 times"; adds the ratio to the figures.
void say_ratio(FindingBuilder& draft, double ratio);

}  // namespace tunewright::verdict
