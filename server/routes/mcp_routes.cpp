#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/mcp/message.h"
#include "api/mcp/protocol.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/routes/job_access.h"
#include "server/routes/mcp_host.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

namespace mcp = api::mcp;
using http::Call;
using http::Response;

constexpr std::size_t kMinLargeMessage = 256 * 1024;  // bytes of a message that is read in a turn
constexpr const char* kRevisionHeader = "MCP-Protocol-Version";

/// The transport demands 400 for a revision that the server does not speak. A client that names none has not yet
/// agreed on one.
std::optional<Response> refuse_revision(const http::Request& request) {
    const std::string revision(request.header(kRevisionHeader));
    if (revision.empty() || mcp::is_revision(revision)) return std::nullopt;
    return http::json_response(
        mcp::error_message(nullptr,
                           {mcp::kInvalidRequest, std::string(kRevisionHeader) + " is " + api::shown(revision) +
                                                      "; this server speaks " + mcp::revisions() + "."}),
        400);
}

/// A large body takes a turn like a computation: reading it may take a second.
std::variant<mcp::Incoming, Response> read_in_turn(const McpParts& parts, http::Request& request) {
    const std::string text = std::exchange(request.body, {});
    if (text.size() <= kMinLargeMessage) return mcp::read_messages(text);
    mcp::Incoming incoming;
    Response refusal = in_turn(parts.turns.computing, request, [&] {
        incoming = mcp::read_messages(text);
        return Response();
    });
    if (refusal.status != 200) return refusal;
    return incoming;
}

Response answered(const McpParts& parts, const http::Request& request, const mcp::Incoming& incoming) {
    McpHost host(parts, request);
    std::vector<std::string> answers;
    for (const auto& part : incoming.parts) {
        const auto* message = std::get_if<mcp::Message>(&part);
        answers.push_back(message ? mcp::answer(*message, host) : std::get<std::string>(part));
        if (request.left && request.left()) return client_gone();
    }
    std::string body = mcp::joined(incoming, answers);
    if (!body.empty()) return http::json_response(std::move(body), incoming.refused() ? 400 : 200);
    Response accepted;
    accepted.status = 202;
    return accepted;
}

Response post_message(const McpParts& parts, Call& call) {
    if (!http::sends_json(call.request))
        return http::problem_response(415, "The body must be JSON, with Content-Type: application/json.");
    if (auto refusal = refuse_revision(call.request)) return *std::move(refusal);
    auto read = read_in_turn(parts, call.request);
    if (auto* refusal = std::get_if<Response>(&read)) return std::move(*refusal);
    return answered(parts, call.request, std::get<mcp::Incoming>(read));
}

}  // namespace

void add_mcp_routes(http::Router& router, JobService& jobs, LongRequestSlots& places, const SharedTurns& turns,
                    const Computations& computations, const api::JobLimits& limits) {
    router.add("POST", "/mcp", [parts = McpParts{jobs, places, turns, computations, limits}](Call& call) {
        return post_message(parts, call);
    });
}

}  // namespace tunewright::server
