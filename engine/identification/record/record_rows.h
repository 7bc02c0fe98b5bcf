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

/// True if the times fall from row to row, but for one in ten: from the newest row to the oldest, as the rows are taken
/// to run, or counted down (time_direction.h).
bool times_fall(const Record& record);

/// The rows as clean_record() describes them, false readings included. The columns of `record` have equal lengths.
RecordRows collect_rows(const Record& record, Cleaning& cleaning);

/// Takes the first rows out, three at most, where u and y both jump away from what they hold with one row, each by more
/// than it moves in all others together, and u moves later on too: a logger's rows of before its first reading.
void drop_unread_rows(RecordRows& rows, Cleaning& cleaning);

/// Takes the first rows out whose y is one number to the digit, where the next row leaves it ten times as far as y
/// moves between any that follow, while u stands still: a sensor that was not read yet.
void drop_silent_rows(RecordRows& rows, Cleaning& cleaning);

/// Takes changes of u out that come with the last sample or after it: nothing of the record shows what they do. A lone
/// change stays, and so do all changes of an input that moves more than twice, as that of a relay or a loop does.
void drop_late_moves(RecordRows& rows, Cleaning& cleaning);

}  // namespace tunewright
