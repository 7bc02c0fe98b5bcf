// A call that was refused or failed, in the words of the service: each fault with its place and its cure.
#pragma once

#include <string>
#include <string_view>

#include "api/mcp/tool.h"

namespace tunewright::api::mcp {

/// The problem as an agent gets it: the first faults, cut where they repeat long names, without the samples of a record
/// that it sent.
Json shown_problem(std::string_view problem);

/// The faults in lines, and a right call where the arguments are at fault.
std::string refusal_text(const Json& problem, const Tool& tool);

/// The refusal of arguments that are not an object.
Refused not_an_object(const Json& arguments);

}  // namespace tunewright::api::mcp
