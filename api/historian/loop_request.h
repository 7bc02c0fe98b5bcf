// The request to check one loop.
#pragma once

#include <string>

#include "api/historian/tagged_loop.h"
#include "api/json/json.h"

namespace tunewright::api {

/// Members that all requests made from one file share.
struct CheckTerms {
    std::string time_unit = "s";  ///< of the times of the loops
    bool unit_given = false;      ///< it is also that of the answer
    bool settings = false;        ///< look for new settings too
};

/// {"name", "units", "settings", "loops": [{"tag", "kind", "csv", "columns", "time_unit", "start", "notes"}]} as JSON
/// text. The columns are named, so that nothing is guessed again, and numbers have full precision. The times count from
/// the first row, whose date is `start`; without dates they are those of the file. A blank cell is a missing value of
/// pv and op; sp and mode hold until the next one. `known`: further members of the loop, an object; its kind overrides
/// that of the tag.
std::string loop_request(const TaggedLoop& loop, const CheckTerms& terms, const Json& known = Json::object());

/// Seconds since 1970 as "2026-11-21T14:05:06.5", with a Z if `utc`.
std::string iso_time(double seconds, bool utc);

}  // namespace tunewright::api
