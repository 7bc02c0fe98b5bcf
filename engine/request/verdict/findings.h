// One entry of an answer as its findings look at it, and all findings: each a function of its figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/request/verdict/thresholds.h"
#include "engine/request/verdict/verdict.h"

namespace tunewright::verdict {

/// What a design was asked to keep; empty: nothing.
struct Limits {
    std::optional<double> Ms, Mt, Mks;
};

/// The loop of which a peak is known: the ideal one, that of the user's controller, or either on the worst of several
/// plants.
enum class PeakLoop { ideal, as_built, worst_plant, ideal_on_worst_plant };

struct PlacedPeak {
    double value = 0;
    PeakLoop loop = PeakLoop::ideal;
    bool on_worst_plant() const { return loop == PeakLoop::worst_plant || loop == PeakLoop::ideal_on_worst_plant; }
};

/// What follows the figure in a sentence: "" or " on the worst plant".
std::string words_of(PeakLoop loop);

/// An entry that has an evaluation.
struct Case {
    const TuningEntry& entry;
    const TuningEntry* today;  ///< of the settings in use, with an evaluation, if it is another entry; else null
    const Context& context;
    const Evaluation& evaluation = *entry.evaluation;

    /// What runs is judged: the loop as it is built, where that is known.
    const Robustness& robustness() const;
    const Performance& performance() const;
    bool built() const { return entry.as_built.has_value(); }
    bool is_today() const { return entry.method == "baseline"; }

    bool has_integral() const;
    bool warned_of(const std::string& code) const;
    Limits limits() const;
    /// The larger of the loop that runs and of the worst of several plants (which is known of the ideal loop alone).
    std::optional<PlacedPeak> worst_Ms() const;
    std::optional<PlacedPeak> worst_Mt() const;
};

/// The loop of an entry that runs; null where there is none.
const Performance& performance_of(const TuningEntry& entry);

// heads.cpp: what the loop is

/// All that apply, the most severe first; at least one. `good` only where every plant that the answer knows of and the
/// loop as it is built are stable and settle, with Ms at most 1.7 and within its limit.
std::vector<Finding> heads(const Case& c);

/// "Ms = 1.40 at 0.21 rad/s", "Mks = 12.0 %/degC": a limit that the design touches, and on which loop.
struct ActiveLimit {
    std::string name;
    double value = 0;
    std::optional<double> omega;
    std::string where;
};
std::vector<ActiveLimit> active_limits(const Case& c);

// What else follows of a loop that is stable; empty where there is nothing to say.

using Found = std::optional<Finding>;

// margins.cpp
Found as_built(const Case& c);           ///< the loop as it is built beside the ideal one
Found active_limit(const Case& c);       ///< which limit stops the design, and where; else the peaks
Found all_members(const Case& c);        ///< the worst of several plants
Found margins(const Case& c);            ///< what may change before the loop oscillates
Found nonlinear_margins(const Case& c);  ///< what margins mean where plant or controller is nonlinear
Found large_errors(const Case& c);       ///< whether the nonlinear integral lets errors of every size die out

// responses.cpp
Found load_error(const Case& c);                      ///< IAE of the load step, against today's
Found overshoot(const Case& c);                       ///< of a set-point step, what was asked for, and what keeps it
std::optional<Level> overshoot_level(const Case& c);  ///< of that finding, known without the search for what keeps it
Found movement(const Case& c);                        ///< of u, against today's

// actuator.cpp
/// Steps for which u has to be beyond its limits at rest, whatever the controller.
struct StepsBeyondActuator {
    bool setpoint = false, load = false;
};
StepsBeyondActuator steps_beyond_actuator(const Case& c);

/// u rests at its limit: the steps that it carries. A note where the request names the size of none of those that it
/// does not.
Found actuator_too_small(const Case& c);
Found at_its_limits(const Case& c);  ///< u reaches the actuator's ends

// causes.cpp
Found PI_or_PID(const Case& c);
Found excess(const Case& c);  ///< over the least IAE at the same Ms
Found dead_time_rules(const Case& c);
Found filter_rules(const Case& c);
Found sample_time(const Case& c);
Found noise(const Case& c);

/// "about a quarter of", "about the same as", "2.4 times"; the ratio goes into the figures.
void say_ratio(Draft& draft, double ratio);

}  // namespace tunewright::verdict
