#include "api/mcp/message.h"

#include <algorithm>
#include <utility>

#include "api/describe/reader.h"

namespace tunewright::api::mcp {

std::string json_text(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

namespace {

std::string invalid(const Json& id, const std::string& sentence) {
    return error_message(id, {kInvalidRequest, sentence});
}

/// The end of the text in quotes that begins at `at`: the place of its second quote, or the end of `json`.
std::size_t end_of_text(std::string_view json, std::size_t at) {
    for (++at; at < json.size() && json[at] != '"'; ++at)
        if (json[at] == '\\') ++at;
    return std::min(at, json.size());
}

/// The id of a message that cannot be read as a whole, such as one with NaN among its numbers: without it the client
/// would wait for its answer. Null if none is found.
Json id_in(std::string_view json) {
    constexpr std::string_view kName = "\"id\"";
    int depth = 0;
    for (std::size_t at = 0; at < json.size(); ++at) {
        if (json[at] == '{' || json[at] == '[') ++depth;
        if (json[at] == '}' || json[at] == ']') --depth;
        if (json[at] != '"') continue;
        const std::size_t end = end_of_text(json, at);
        std::string_view rest = json.substr(std::min(end + 1, json.size()));
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
        if (depth == 1 && json.substr(at, end + 1 - at) == kName && rest.starts_with(':')) {
            rest.remove_prefix(1);
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
            const std::size_t length =
                rest.starts_with('"') ? end_of_text(rest, 0) + 1 : rest.find_first_of(",} \t\r\n");
            if (length > kMaxIdLength) return nullptr;
            const Json id = Json::parse(rest.substr(0, length), nullptr, false);
            return id.is_string() || id.is_number_integer() ? id : Json();
        }
        at = end;
    }
    return nullptr;
}

bool is_id(const Json& id) {
    return id.is_number_integer() || (id.is_string() && id.get_ref<const std::string&>().size() <= kMaxIdLength);
}

std::variant<Message, std::string> message_of(const Json& value) {
    if (!value.is_object()) return invalid(nullptr, "A message must be an object; this is " + kind_of(value) + ".");
    Message message;
    if (const auto id = value.find("id"); id != value.end()) {
        if (!is_id(*id)) return invalid(nullptr, "id is " + shown(*id) + "; it must be a text or a whole number.");
        message.id = *id;
    }
    if (const auto version = value.find("jsonrpc"); version == value.end() || *version != "2.0")
        return invalid(message.id, "jsonrpc must be \"2.0\".");
    const auto method = value.find("method");
    if (method == value.end()) {
        if (value.contains("result") || value.contains("error")) return Message{};
        return invalid(message.id, "method is missing; it must be a text such as \"tools/list\".");
    }
    if (!method->is_string() || method->get_ref<const std::string&>().empty())
        return invalid(message.id, "method is " + shown(*method) + "; it must be a text such as \"tools/list\".");
    message.method = method->get<std::string>();
    if (const auto params = value.find("params"); params != value.end() && !params->is_null()) {
        if (!params->is_object())
            return error_message(message.id,
                                 {kInvalidParams, "params is " + kind_of(*params) + "; it must be an object."});
        message.params = *params;
    }
    return message;
}

}  // namespace

bool Incoming::refused() const {
    return std::ranges::none_of(parts, [](const auto& part) { return std::holds_alternative<Message>(part); });
}

Incoming read_messages(std::string_view text) {
    auto parsed = parse(text);
    if (const auto* problem = std::get_if<Problem>(&parsed)) {
        const int code = problem->status == 400 ? kParseError : kInvalidRequest;
        return {false, {error_message(id_in(text), {code, problem->detail})}};
    }
    const Json& value = std::get<Json>(parsed);
    if (!value.is_array()) return {false, {message_of(value)}};
    if (value.empty() || value.size() > kMaxBatch)
        return {false,
                {invalid(nullptr, "The array has " + std::to_string(value.size()) + " messages; it must have 1 to " +
                                      std::to_string(kMaxBatch) + ".")}};
    Incoming incoming{true, {}};
    for (const Json& each : value) incoming.parts.push_back(message_of(each));
    return incoming;
}

std::string result_message(const Json& id, std::string_view result) {
    std::string out = "{\"jsonrpc\":\"2.0\",\"id\":" + json_text(id) + ",\"result\":";
    return out.append(result).append("}");
}

std::string error_message(const Json& id, const RpcError& error) {
    return json_text({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", error.code}, {"message", error.message}}}});
}

std::string joined(const Incoming& incoming, const std::vector<std::string>& answers) {
    std::string out;
    for (const std::string& answer : answers)
        if (!answer.empty()) out += (out.empty() ? "" : ",") + answer;
    return incoming.batch && !out.empty() ? "[" + out + "]" : out;
}

}  // namespace tunewright::api::mcp
