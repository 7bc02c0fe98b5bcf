// The parts of a loop's record: its rest before the set point moves, and the rows in which the controller was in
// manual.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// The mean of u, in the record's units, before the set point first moves: there the plant rests. Empty where fewer
/// than five rows come before that, where y or u moves in them (record_kind.h), and where the set point never moves.
/// `r` is the set point at the record's samples, or its moves, in any unit.
std::optional<double> level_before_set_point(const CleanRecord& record, const std::vector<double>& r);

/// The row at which a controller took over: before it u stands still.
struct SwitchOn {
    int row = 0;          ///< index of the first sample at which the controller moves u
    double y_before = 0;  ///< mean of y over the rows just before, dimensionless
};

/// The row at which the first five rows of stillness, or more, end and u moves on and on. Empty where
/// - the set point `r` (at the samples, as y; may be empty) moves within two rows of it, which is a move of its own, or
///   is within a twentieth of y's range of y there: nothing is then to be moved;
/// - y has left what it was in the rows before: then y moves u, and not somebody.
std::optional<SwitchOn> switched_on(const CleanRecord& record, const std::vector<double>& r);

/// First and last time, in the record's units.
struct Stretch {
    double from = 0, to = 0;
    bool whole_start = false;      ///< it begins with the record
    bool one_step_to_end = false;  ///< u steps once, to an end of its range: a controller may have been switched on
};

/// Of the rows in manual, where somebody stepped u or left it alone, the longest stretch: changes of u are ten rows
/// apart and more in it, beside one in which they are not. It has 30 rows and more, and holds a move of u by a
/// twentieth of u's range with 15 rows after it. Empty where there is none.
std::optional<Stretch> manual_stretch(const CleanRecord& record);

/// The rows of a stretch alone, without the set point, which in manual moves nothing.
Record rows_of(const Record& record, const Stretch& stretch);

/// Whether a controller moves u in the rows before the stretch, or in those after it.
bool feedback_outside(const Record& record, const Stretch& stretch);

}  // namespace tunewright
