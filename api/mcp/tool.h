// A tool: what an agent may call, with the description that it reads first.
#pragma once

#include <string>
#include <variant>

#include "api/json/json.h"
#include "api/mcp/tool_host.h"
#include "api/mcp/tool_schema.h"

namespace tunewright::api::mcp {

/// The result of a call that succeeded.
struct ToolAnswer {
    std::string text;  ///< short, readable
    Json figures;      ///< the same as an object for programs; null: the text is all
};

using ToolOutcome = std::variant<ToolAnswer, Refused>;

struct Tool {
    const char* name;                                            ///< snake_case
    const char* title;                                           ///< for people
    const char* description;                                     ///< for agents: purpose, when to use it, units
    const char* example;                                         ///< the arguments of a right call, as JSON
    bool makes_job;                                              ///< its answer is that of ToolHost::run()
    Json (*arguments)(ShownTypes& shown);                        ///< the JSON Schema of its arguments
    ToolOutcome (*call)(const Json& arguments, ToolHost& host);  ///< the arguments are an object
};

}  // namespace tunewright::api::mcp
