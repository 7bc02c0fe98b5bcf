// The parts of a loop's record: its rest before the set point moves, and the rows in which the controller was in
// manual.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// The mean of u, in the record's units, before the set point first moves: the input with which the plant is at rest.
/// Empty if there are fewer than five rows before that, if y or u moves in them (record_kind.h), or if the set point
/// never moves. `r` is the set point at the record's samples, or its moves, in any unit.
std::optional<double> level_before_set_point(const CleanRecord& record, const std::vector<double>& r);

/// The row at which a controller was switched on: before it u is constant.
struct SwitchOn {
    int row = 0;          ///< index of the first sample at which the controller moves u
    double y_before = 0;  ///< mean of y over the rows just before, dimensionless
};

/// The row at which u, constant in the first five rows or more, begins to move continually. Empty if
/// - the set point `r` (at the samples, as y; may be empty) moves within two rows of it, which is a separate move, or
///   is within a twentieth of y's range of y there, so that there is nothing to control;
/// - y has already left its previous value: then y moves u, and not the switch.
std::optional<SwitchOn> switched_on(const CleanRecord& record, const std::vector<double>& r);

/// First and last time, in the record's units.
struct Stretch {
    double from = 0, to = 0;
    bool whole_start = false;      ///< it begins with the record
    bool one_step_to_end = false;  ///< u steps once, to an end of its range: a controller may have been switched on
};

/// The longest interval in manual: changes of u in it are at least ten rows apart, while elsewhere they are not. It has
/// at least 30 rows, and contains a move of u by a twentieth of u's range with 15 rows after it. Empty if there is
/// none.
std::optional<Stretch> manual_stretch(const CleanRecord& record);

/// Only the rows of an interval, without the set point, which has no effect in manual.
Record rows_of(const Record& record, const Stretch& stretch);

/// True if a controller moves u in the rows before the interval, or in those after it.
bool feedback_outside(const Record& record, const Stretch& stretch);

}  // namespace tunewright
