// JSON-RPC 2.0 messages, as the Model Context Protocol sends them.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/json/json.h"

namespace tunewright::api::mcp {

/// An error of the protocol itself. What is wrong with a tool's arguments is the tool's result instead.
struct RpcError {
    int code;
    std::string message;
};
inline constexpr int kParseError = -32700, kInvalidRequest = -32600, kMethodNotFound = -32601, kInvalidParams = -32602,
                     kInternalError = -32603, kResourceNotFound = -32002, kOverloaded = -32000;

struct Message {
    Json id;                       ///< a text or a whole number; null: a notification, which is not answered
    std::string method;            ///< "": an answer of the client, which is not answered either
    Json params = Json::object();  ///< an object
};

constexpr std::size_t kMaxBatch = 10;       ///< messages of one array
constexpr std::size_t kMaxIdLength = 1000;  ///< bytes of an id

/// The messages of a text; in the place of one that is not valid, the answer that refuses it.
struct Incoming {
    bool batch = false;  ///< an array, as the revision 2025-03-26 has it: its answers are one array
    std::vector<std::variant<Message, std::string>> parts;

    /// True if no part is a message.
    bool refused() const;
};

/// Reads one message, or an array of at most kMaxBatch. Never fails: what is not valid becomes an answer.
Incoming read_messages(std::string_view text);

/// The value as text; bytes of its texts that are not UTF-8 are replaced.
std::string json_text(const Json& value);

/// The answer with that result, JSON text.
std::string result_message(const Json& id, std::string_view result);
std::string error_message(const Json& id, const RpcError& error);

/// The answers to an incoming text in its form: "" if there is none.
std::string joined(const Incoming& incoming, const std::vector<std::string>& answers);

}  // namespace tunewright::api::mcp
