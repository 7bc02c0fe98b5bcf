// Source text of a controller of a result, or of the schedule of a range, for the calls and the command `code`.
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

/// The program of the controller number `index` (a decimal, from 0; "": the best of the result's ranking, or the
/// schedule of a range). Problems: 400 not JSON; 404 no result, no such controller, or an entry without one; 422 with
/// every fault of the parameters, a time unit that cannot be converted to seconds, or no sample time.
std::variant<ControllerCode, Problem> controller_code(const ResultSource& source, const std::string& index,
                                                      const CodeWords& words);

/// The program of all controllers of a structure. Problems: as above; 404 no answer about a structure.
std::variant<ControllerCode, Problem> structure_code(const ResultSource& source, const CodeWords& words);

/// The program of the schedule in an answer about an operating range, with the scheduling variable as a further input.
/// Problems: as above; 404 no such answer or one without a schedule; 422 rows that one program cannot follow.
std::variant<ControllerCode, Problem> schedule_code(const ResultSource& source, const CodeWords& words);

}  // namespace tunewright::api
