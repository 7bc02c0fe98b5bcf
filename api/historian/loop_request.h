// The request to check one loop.
#pragma once

#include <string>

#include "api/historian/tagged_loop.h"

namespace tunewright::api {

/// {"name", "units", "loops": [{"tag", "kind", "csv", "columns", "time_unit", "start"}]} as JSON text. The columns are
/// named, so that nothing is guessed again, and numbers have full precision. The times count from the first row, whose
/// date is `start`; without dates they are those of the file. A blank cell is a missing value of pv and op; sp and mode
/// hold until the next one. `time_unit`: of the times of the loop; `given`: it is also that of the answer.
std::string loop_request(const TaggedLoop& loop, const std::string& time_unit, bool given);

/// Seconds since 1970 as "2026-11-21T14:05:06.5", with a Z if `utc`.
std::string iso_time(double seconds, bool utc);

}  // namespace tunewright::api
