// The program of a structure's controllers, from an answer about it.
#pragma once

#include <variant>

#include "api/chosen_entry.h"
#include "api/code/code.h"
#include "api/code/parameters.h"
#include "engine/code/program.h"

namespace tunewright::api {

struct StructureProgram {
    code::Program program;
    SampleTime sample_time;  ///< in the unit of the program
};

/// `asked.unit`: the program's unit of time in the answer's, seconds for a user. Problems: as in structure_code().
/// Throws Json::exception for an answer whose members have other types.
std::variant<StructureProgram, Problem> structure_program(const Json& answer, const Json& request,
                                                          const AskedCode& asked);

/// Problems: as in structure_code(). Throws Json::exception for an answer whose members have other types.
std::variant<ControllerCode, Problem> written_structure(const ChosenEntry& found, const CodeWords& words);

}  // namespace tunewright::api
