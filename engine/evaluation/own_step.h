// A step of the user's own loop: its size, place and limits, in the user's units instead of deviations.
#pragma once

#include <optional>

#include "engine/error.h"
#include "engine/simulation/course/course.h"

namespace tunewright {

/// The loop is at rest at `y` and `u` before t = 0. Then the set point goes to `target`, at once or as a ramp, and a
/// load follows. y in units of y, u in units of u, times in the plant's time.
struct OwnStep {
    struct Load {
        double size = 0;         ///< != 0; units of u at the plant's input, of y at its output
        bool at_output = false;  ///< else at the plant's input
        LoadShape shape = LoadShape::step;
        std::optional<double> duration;  ///< > 0: for a pulse and a ramp, which need it
    };
    double y = 0, u = 0;
    double target = 0;
    std::optional<double> u_min, u_max;  ///< u_min <= u <= u_max, u_min < u_max; empty: no limit
    std::optional<double> ramp_rate;     ///< > 0: the set point's rate; empty: a step
    std::optional<double> hold;          ///< >= 0: from the end of the ramp to the load; empty: until y rests
    std::optional<Load> load;            ///< without it the target differs from y
    std::optional<double> length;        ///< > 0: the time that is simulated; empty: until the loop rests
};

/// The first member that breaks one of these conditions, `where` below "evaluate/own_step".
std::optional<Error> refuse_own_step(const OwnStep& step);

}  // namespace tunewright
