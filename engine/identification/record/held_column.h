// A column that keeps each value until the next one, by its changes: the set point, the mode of the loop.
#pragma once

#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// The value is value[i] from time[i] until time[i + 1], and value[0] before too. Equal lengths; times ascend, in the
/// record's unit.
struct HeldColumn {
    std::vector<double> time, value;

    bool empty() const { return time.empty(); }
};

/// The changes of `values` over the times `t`, in the order of time; of rows of equal time the last one counts. Rows
/// without a time or a value are left out.
HeldColumn held_column(const std::vector<double>& t, const std::vector<double>& values);

/// The column at the samples of `record`, in its own unit; empty if the column is.
std::vector<double> at_samples(const HeldColumn& column, const CleanRecord& record);

}  // namespace tunewright
