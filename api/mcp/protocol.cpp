#include "api/mcp/protocol.h"

#include <algorithm>
#include <array>
#include <variant>
#include <vector>

#include "api/describe/reader.h"
#include "api/describe/suggest.h"
#include "api/mcp/refusal.h"
#include "api/mcp/tools.h"

namespace tunewright::api::mcp {
namespace {

using Result = std::variant<std::string, RpcError>;
constexpr std::array kRevisions = {"2025-06-18", "2025-03-26", "2024-11-05"};

constexpr std::size_t kMaxResource = 1 << 20;  // bytes of a whole answer that a client gets at once

constexpr const char* kInstructions =
    "Tunes PID controllers with exact models instead of guesses. Usual order: identify a recorded test (or write the "
    "plant as text, \"2 e^(-3s)/(10s+1)\"), tune, then settings or tune's `implement` for the values to type into a "
    "product, and code for a program. check_record finds out whether tuning is the problem at all. All times are in "
    "one unit, seconds unless units.time says otherwise; gains are in the units of u and y. Say what the verdict and "
    "the warnings of an answer say, and do not judge the figures yourself. Nothing here writes to a plant: a person "
    "enters the settings.";

Json at(const Message& message, const char* name) { return message.params.value(name, Json()); }

std::string detail_of(const Refused& refusal) { return shown_problem(refusal.problem).value("detail", ""); }

Result initialize(const Message& message, ToolHost&) {
    const Json asked = at(message, "protocolVersion");
    if (!asked.is_string())
        return RpcError{kInvalidParams, "protocolVersion is missing; it must be a text such as \"" +
                                            std::string(kRevisions.front()) + "\"."};
    const auto& revision = asked.get_ref<const std::string&>();
    const Json answer{
        {"protocolVersion", is_revision(revision) ? revision : kRevisions.front()},
        {"capabilities", {{"tools", Json::object()}, {"resources", Json::object()}}},
        {"serverInfo", {{"name", "tunewright"}, {"title", "Tunewright"}, {"version", TUNEWRIGHT_VERSION}}},
        {"instructions", kInstructions}};
    return answer.dump();
}

Result ping(const Message&, ToolHost&) { return "{}"; }

Result list_tools(const Message&, ToolHost& host) { return tool_list(host); }

Result call(const Message& message, ToolHost& host) {
    const Json name = at(message, "name");
    if (!name.is_string()) return RpcError{kInvalidParams, "name is missing; it must be that of a tool."};
    const Tool* tool = find_tool(name.get_ref<const std::string&>());
    if (tool == nullptr) return RpcError{kInvalidParams, no_such_tool(name.get<std::string>())};
    return call_tool(*tool, at(message, "arguments"), host);
}

/// The newest answers, which a client may offer to its user.
Result list_resources(const Message&, ToolHost& host) {
    const auto found = host.newest();
    if (const auto* refusal = std::get_if<Refused>(&found)) return RpcError{kInternalError, detail_of(*refusal)};
    Json resources = Json::array();
    const Json list = Json::parse(std::get<std::string>(found));
    for (const Json& job : list.at("jobs")) {
        const auto id = job.at("id").get<std::string>();
        const Json name = job.value("name", Json());
        resources.push_back({{"uri", kAnswerResource + id},
                             {"name", name.is_string() ? name : Json("Answer " + id)},
                             {"mimeType", "application/json"}});
    }
    return Json{{"resources", std::move(resources)}}.dump();
}

Result list_templates(const Message&, ToolHost&) {
    const Json answer{{"resourceTemplates",
                       {{{"uriTemplate", std::string(kAnswerResource) + "{job}"},
                         {"name", "answer"},
                         {"title", "The whole answer of a job"},
                         {"description", "Request and result with every figure, by the id in a tool's answer."},
                         {"mimeType", "application/json"}}}}};
    return answer.dump();
}

/// {"id": ..., "status": ..., "request": ..., "result": ...}, the texts as they are.
std::string whole_answer(const ToolJob& job) {
    std::string out = "{\"id\":" + Json(job.id).dump() + ",\"status\":" + Json(job.status).dump();
    for (const auto& [name, text] :
         {std::pair{"request", &job.request}, {"result", &job.result}, {"error", &job.error}})
        if (!text->empty()) out += ",\"" + std::string(name) + "\":" + *text;
    return out + "}";
}

Result read_resource(const Message& message, ToolHost& host) {
    const Json uri = at(message, "uri");
    const std::string text = uri.is_string() ? uri.get<std::string>() : "";
    if (!text.starts_with(kAnswerResource))
        return RpcError{kResourceNotFound, "There is no resource " + shown(uri) + "; they are " + kAnswerResource +
                                               "ID, with the id of a job from the answer of a tool."};
    const auto found = host.find(text.substr(std::string_view(kAnswerResource).size()), false);
    if (const auto* refusal = std::get_if<Refused>(&found)) return RpcError{kResourceNotFound, detail_of(*refusal)};
    const std::string whole = whole_answer(std::get<ToolJob>(found));
    if (whole.size() > kMaxResource)
        return RpcError{kInternalError, "The whole answer has " + std::to_string(whole.size() >> 10) +
                                            " KiB, too much for a resource. Ask without traces or with fewer methods, "
                                            "or fetch it with GET /v1/jobs/ID."};
    return json_text({{"contents", {{{"uri", text}, {"mimeType", "application/json"}, {"text", whole}}}}});
}

struct Method {
    const char* name;
    Result (*answer)(const Message& message, ToolHost& host);
};
constexpr std::array kMethods = {
    Method{"initialize", initialize},         Method{"ping", ping},
    Method{"tools/list", list_tools},         Method{"tools/call", call},
    Method{"resources/list", list_resources}, Method{"resources/templates/list", list_templates},
    Method{"resources/read", read_resource}};

RpcError no_such_method(const std::string& name) {
    std::vector<std::string> names;
    for (const Method& method : kMethods) names.emplace_back(method.name);
    return {kMethodNotFound, "There is no method " + shown(name) + "; there are " + listed(names, "and") + "."};
}

}  // namespace

bool is_revision(std::string_view revision) { return std::ranges::find(kRevisions, revision) != kRevisions.end(); }

std::string revisions() {
    const std::vector<std::string> names(kRevisions.begin(), kRevisions.end());
    return listed(names, "and");
}

std::string answer(const Message& message, ToolHost& host) {
    if (message.id.is_null()) return "";
    const auto found =
        std::ranges::find_if(kMethods, [&](const Method& method) { return message.method == method.name; });
    const Result result =
        found == kMethods.end() ? Result(no_such_method(message.method)) : found->answer(message, host);
    if (const auto* error = std::get_if<RpcError>(&result)) return error_message(message.id, *error);
    return result_message(message.id, std::get<std::string>(result));
}

bool computes(const Message& message) { return !message.id.is_null() && message.method == "tools/call"; }

}  // namespace tunewright::api::mcp
