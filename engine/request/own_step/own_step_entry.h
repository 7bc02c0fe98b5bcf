// The user's own step with the controller of one entry: figures and traces in the user's units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/figure.h"

namespace tunewright {

enum class OwnStepRefusal {
    no_time,    ///< the plant is known by points of its frequency response
    equations,  ///< the plant is given by equations
    no_law,     ///< a nonlinear integral
    unstable,   ///< the loop is unstable
    impulse,    ///< a jump of y meets a derivative without filter
};

struct OwnSetpointFigures {
    Figure IAE;                ///< integral of |r - y| up to the load, y's unit times time
    Figure overshoot;          ///< of y over the target, in y's unit, >= 0
    Figure overshoot_percent;  ///< the same in percent of the step
    Figure settling_time;      ///< last time before the load outside 2 % of the step
};

struct OwnLoadFigures {
    double start = 0;      ///< time at which it begins
    Figure IAE;            ///< integral of |r - y| from there on
    Figure peak;           ///< largest deviation of y from the target, signed
    Figure recovery_time;  ///< last time from its start outside 2 % of the peak
};

struct OwnStepTrace {
    std::vector<double> t, r, y, u;  ///< values themselves, not deviations
};

struct OwnStepEntry {
    std::optional<OwnStepRefusal> refused;  ///< if set, the rest is meaningless
    std::optional<OwnSetpointFigures> setpoint;
    std::optional<OwnLoadFigures> load;
    double u_min = 0, u_max = 0;      ///< the range in which u moves
    double travel = 0;                ///< total variation of u
    Figure time_at_min, time_at_max;  ///< time that u spends at its limits; no value if it stays there
    Figure u_needed;  ///< u that would hold the target in the end; beyond a limit the target is out of reach
    Figure y_final;   ///< y at rest in the end
    bool settles = true;
    std::optional<OwnStepTrace> trace;
};

/// "no-time", "equations", ...
const char* name_of(OwnStepRefusal refusal);
/// The reason and the cure in one or two sentences.
const char* reason_of(OwnStepRefusal refusal);

}  // namespace tunewright
