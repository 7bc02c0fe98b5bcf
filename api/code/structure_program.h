// The program of a structure's controllers, from an answer about it.
#pragma once

#include <variant>

#include "api/chosen_entry.h"
#include "api/code/code.h"

namespace tunewright::api {

/// Problems: as in structure_code(). Throws Json::exception for an answer whose members have other types.
std::variant<ControllerCode, Problem> written_structure(const ChosenEntry& found, const CodeWords& words);

}  // namespace tunewright::api
