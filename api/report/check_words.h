// The codes of a check in words, as the page has them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/json/json.h"

namespace tunewright::api {

/// "Sticking valve" for "stiction". A code that is not known is returned unchanged, here and below.
std::string verdict_title(std::string_view verdict);
/// "repair the valve" for "repair-valve".
std::string action_title(std::string_view action);
/// The same of a loop of the answer; "correct FIC101 first" for one whose source is known by its `rank`.
std::string action_title(const Json& result, std::string_view action, const Json& rank);
/// Whose work it is; "–" for nobody.
std::string owner_title(std::string_view owner);
/// "work on the plant" for 3.
std::string effort_title(const Json& effort);

/// True if a result is that of a check.
bool is_of_check(const Json& result);

/// "4 loops: 1 sticking valve, 2 healthy.", the causes in the order of the work list; "" if `result` has no loops.
std::string check_summary(const Json& result);

/// Indices into `loops` in the order of the ranking; loops that it leaves out come last.
std::vector<std::size_t> work_order(const Json& result);

/// Loops with a page of their own in a report, in the order of the work list: all if they are at most 50, else the
/// first 50 with a cause.
std::vector<std::size_t> loops_with_page(const Json& result);

/// The tag of loop number `loop`, a number in the JSON; "" if there is none.
std::string tag_of_loop(const Json& result, const Json& loop);

/// "FIC101, LIC104": the tags of a list of loops.
std::string tags_of_loops(const Json& result, const Json& places);

}  // namespace tunewright::api
