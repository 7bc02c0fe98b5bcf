// The levels at which y settles while u stands still: a static gain must explain them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// A stretch between two moves of u at whose end y rests, dimensionless.
struct SettledLevel {
    double u = 0, y = 0;  ///< y: mean over the last tenth
    double until = 0;     ///< time
};

/// Stretches of ten samples and more in which y moves, over their last quarter, by less than 3 % of what it moves in
/// the whole of them, or by less than a fiftieth of its range.
std::vector<SettledLevel> settled_levels(const CleanRecord& record);

/// Looks for levels that no linear model of a self-regulating plant explains:
/// - y settles a quarter of its range apart at one level of u (within a twentieth of u's range): u alone does not
///   decide where y goes. Warning contradictory-levels, of level bad, which a loop's record lowers
///   (closed_loop/closed_loop.h);
/// - the gains between neighbouring levels differ by half and more: warning gain-varies, with each gain.
/// In the record's units. Empty where y's levels lie on a line.
std::optional<Warning> level_warning(const CleanRecord& record);

}  // namespace tunewright
