// The rows of a record in time order, still in the user's units.
#pragma once

#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// Samples (t, y and number have equal lengths) and changes of u (change_time and change_level have equal lengths).
struct RecordRows {
    std::vector<double> t, y;
    std::vector<int> number;  ///< of each sample: its line in the file, or its index in the record
    std::vector<double> change_time, change_level;
    double u_rest = 0;     ///< u before its first change
    bool started = false;  ///< a row with a time and a u has been seen
};

/// True if the times fall from row to row, with at most one exception in ten: the rows run from the newest to the
/// oldest, which is assumed, or the times count down (time_direction.h).
bool times_fall(const Record& record);

/// The rows as clean_record() describes them, false readings included. The columns of `record` have equal lengths.
RecordRows collect_rows(const Record& record, Cleaning& cleaning);

/// Removes the first rows, at most three, if u and y both jump after them, each by more than it moves in all other rows
/// together, and u moves later too: rows of a logger before its first reading.
void drop_unread_rows(RecordRows& rows, Cleaning& cleaning);

/// Removes the first rows if their y is exactly constant and then jumps ten times as far as it moves between any later
/// rows, while u is constant: a sensor that had not been read yet.
void drop_silent_rows(RecordRows& rows, Cleaning& cleaning);

/// Removes changes of u at the last sample or after it, because the record does not show their effect. A single change
/// stays, and so do all changes of an input that moves more than twice, as with a relay or a loop.
void drop_late_moves(RecordRows& rows, Cleaning& cleaning);

}  // namespace tunewright
