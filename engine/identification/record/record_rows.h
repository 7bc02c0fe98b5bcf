// The rows of a record in time order, still in the user's units.
#pragma once

#include "engine/identification/record/clean_record.h"

namespace tunewright {

struct Rows {
    std::vector<double> t, y;
    std::vector<int> number;  ///< of each sample: its line, or its index
    std::vector<double> change_time, change_level;
    double u_rest = 0;
    bool started = false;
};

/// As clean_record says, without the spikes. Columns are of equal length.
Rows collect_rows(const Record& record, Cleaning& cleaning);

/// Takes changes of u out that come with the last sample or after it: nothing of the record shows what they do. The
/// last change that there is stays, and all of an input that moves more than twice: a relay, a loop.
void drop_late_moves(Rows& rows, Cleaning& cleaning);

/// Takes the readings out that are plainly false.
void drop_false_readings(Rows& rows, Cleaning& cleaning);

}  // namespace tunewright
