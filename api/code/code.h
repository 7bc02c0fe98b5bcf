// A controller of a result, or the schedule of a range, as source text: what the calls and the command `code` answer.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/chosen_entry.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// Parameters as they were typed, by name.
using CodeWords = std::vector<std::pair<std::string, std::string>>;

struct ControllerCode {
    std::string media_type, file_name, text;
};

/// The controller number `index` (a decimal, from 0; "": the best of the result's ranking, or the schedule of a range).
/// Problems: 400 not JSON; 404 no result, no such controller, or an entry without one; 422 parameters with every fault,
/// a time unit that has no seconds, no sample time to propose.
std::variant<ControllerCode, Problem> controller_code(const ResultSource& source, const std::string& index,
                                                      const CodeWords& words);

/// The schedule of an answer about an operating range: a program with one more input, the scheduling variable.
/// Problems: as above; 404 no such answer or one without a schedule; 422 rows that one program cannot follow.
std::variant<ControllerCode, Problem> schedule_code(const ResultSource& source, const CodeWords& words);

}  // namespace tunewright::api
