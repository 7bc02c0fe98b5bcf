// The answer of a tool that runs a job, and of one that reads it.
#pragma once

#include "api/mcp/tool.h"

namespace tunewright::api::mcp {

/// Runs the request as a job, without traces unless it asks for them. The terms of a job (webhook, start time, ...) are
/// refused: they act outside the answer.
ToolOutcome run_as_job(Json request, ToolHost& host);

/// The short answer of a job that has succeeded, its problem if it failed, else its state and how to ask again.
ToolOutcome job_outcome(const ToolJob& job, const ToolHost& host);

/// Adds where the whole answer is, if it was kept.
void add_addresses(ToolAnswer& answer, const std::string& id, const std::string& screen, const ToolHost& host);

/// Computes, shortens a success, and adds where the whole answer is.
ToolOutcome computed(const Computation& work, ToolAnswer (*shorten)(std::string_view), ToolHost& host);

}  // namespace tunewright::api::mcp
