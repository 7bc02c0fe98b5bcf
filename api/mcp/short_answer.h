// Answers short enough for an agent's context: the tables and sentences of the terminal, and their figures as an
// object. Figures are rounded to five significant digits; the whole answer has them in full precision.
#pragma once

#include <string_view>

#include "api/mcp/tool.h"

namespace tunewright::api::mcp {

/// For a result of any kind: a loop, an operating range, a check or a structure.
ToolAnswer short_result(std::string_view result);

ToolAnswer short_model(std::string_view answer);       ///< of an identification
ToolAnswer short_relay(std::string_view answer);       ///< of a relay experiment
ToolAnswer short_settings(std::string_view answer);    ///< of a controller as settings of a product
ToolAnswer short_controller(std::string_view answer);  ///< of settings as a controller
ToolAnswer short_jobs(std::string_view list);          ///< of a list of jobs
ToolAnswer short_products(const Json& products);       ///< of product summaries

/// "form ideal, Kp 0.8381, Ti 5.691, filter.Tf 0.1306": the members of an object on one line.
std::string one_line(const Json& object);

/// The value with its numbers rounded to five significant digits.
Json rounded(const Json& value);

}  // namespace tunewright::api::mcp
