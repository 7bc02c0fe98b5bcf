// The methods of the Model Context Protocol, revisions 2024-11-05, 2025-03-26 and 2025-06-18, on any transport.
#pragma once

#include <string>
#include <string_view>

#include "api/mcp/message.h"
#include "api/mcp/tool_host.h"

namespace tunewright::api::mcp {

/// True for a revision that this server speaks.
bool is_revision(std::string_view revision);

/// "2025-06-18, 2025-03-26 and 2024-11-05".
std::string revisions();

/// The answer to a message; "" for a notification, or for an answer of the client. Never changes what other messages
/// get: sessions do not exist.
std::string answer(const Message& message, ToolHost& host);

/// True for a message that may compute for a while; all others are answered at once.
bool computes(const Message& message);

}  // namespace tunewright::api::mcp
