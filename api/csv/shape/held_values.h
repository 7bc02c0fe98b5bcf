// Values that are written where they change, and hold until the next one.
#pragma once

#include <vector>

#include "api/csv/record.h"

namespace tunewright::api {

/// Of a set point, NaN where a row has none: each value holds until the next one, the first one from the beginning.
/// False, and `r` empty, where there is no number.
bool hold_reference(std::vector<double>& r);

/// Of a table made from values with times of their own (pivot.h): u of a time that has none is that of the time before.
/// A row without y stays only where u or a measured disturbance moves.
void hold_input(CsvRecord& record);

}  // namespace tunewright::api
