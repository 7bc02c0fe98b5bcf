// A controller of a result as source text: what the call and the command `code` answer.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/chosen_entry.h"
#include "api/problem.h"

namespace tunewright::api {

/// Parameters as they were typed, by name.
using CodeWords = std::vector<std::pair<std::string, std::string>>;

struct ControllerCode {
    std::string media_type, file_name, text;
};

/// The controller number `index` (a decimal, from 0; "": the best of the result's ranking). Problems: 400 not JSON; 404
/// no result, no such controller, or an entry without one; 422 parameters with every fault, a time unit that has no
/// seconds, no sample time to propose.
std::variant<ControllerCode, Problem> controller_code(const ResultSource& source, const std::string& index,
                                                      const CodeWords& words);

}  // namespace tunewright::api
