// Values that are logged when they change, and hold until the next one.
#pragma once

#include <vector>

#include "api/csv/csv_record.h"

namespace tunewright::api {

/// Fills the rows of a set point that are NaN: each value holds until the next one, the first from the beginning.
/// Clears `r` and returns false if no row has a set point.
bool hold_reference(std::vector<double>& r);

/// For a table made from values with times of their own (pivot.h): a row without u takes the previous value. A row
/// without y is kept only if u or a measured disturbance moves in it.
void hold_input(CsvRecord& record);

}  // namespace tunewright::api
