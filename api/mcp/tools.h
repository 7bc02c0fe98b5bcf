// All tools, in the order of their list.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/mcp/tool.h"

namespace tunewright::api::mcp {

Tool tune_tool();
Tool identify_tool();
Tool check_record_tool();
Tool compare_tool();
Tool evaluate_tool();
Tool plan_relay_test_tool();
Tool settings_tool();
Tool list_products_tool();
Tool list_methods_tool();
Tool code_tool();
Tool test_program_tool();
Tool job_status_tool();

const std::vector<Tool>& tools();

/// The tool of that name; null if there is none.
const Tool* find_tool(std::string_view name);

/// "There is no tool ...", with the nearest name and all names.
std::string no_such_tool(const std::string& name);

/// The result of tools/list, JSON.
std::string tool_list(const ToolHost& host);

/// The result of tools/call, JSON: the answer, or the refusal with each fault, its place and its cure. `arguments`: as
/// sent; null if they are missing.
std::string call_tool(const Tool& tool, const Json& arguments, ToolHost& host);

}  // namespace tunewright::api::mcp
