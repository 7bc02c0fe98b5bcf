// The levels at which y settles while u is constant: a static gain must explain them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// An interval between two moves of u at whose end y is at rest, dimensionless.
struct SettledLevel {
    double u = 0, y = 0;  ///< y: mean over the last tenth
    double until = 0;     ///< time
};

/// Intervals of at least ten samples in whose last quarter y moves by less than 3 % of its movement in the whole
/// interval, or by less than a fiftieth of its range.
std::vector<SettledLevel> settled_levels(const CleanRecord& record);

/// Checks for levels that no linear model of a self-regulating plant explains:
/// - y settles a quarter of its range apart at one level of u (within a twentieth of u's range): u alone does not
///   decide where y goes. Warning contradictory-levels, of level bad, which is lower for the record of a loop
///   (closed_loop/closed_loop.h);
/// - the gains between neighbouring levels differ by half and more: warning gain-varies, with each gain. In the
///   record's units. Empty if y's levels lie on a line.
std::optional<Warning> level_warning(const CleanRecord& record);

}  // namespace tunewright
