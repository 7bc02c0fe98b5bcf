// A host for the tests of tools: it computes on the calling thread and keeps one job.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/json.h"
#include "api/mcp/message.h"
#include "api/mcp/protocol.h"
#include "api/mcp/tool_host.h"

namespace tunewright::api::mcp {

class PlainHost final : public ToolHost {
public:
    std::pair<Answer, std::string> compute(const Computation& work) override { return {work({}), ""}; }

    std::variant<ToolJob, Refused> run(PreparedJob prepared) override {
        JobOutcome outcome = run_job(StoredRequest{prepared.request_json, prepared.request_hash}, {});
        if (!outcome.error_json.empty()) return Refused{outcome.error_json};
        job = ToolJob{"7", "succeeded", prepared.request_json, outcome.result_json, "", ""};
        return *job;
    }

    std::variant<ToolJob, Refused> find(const std::string& id, bool) override {
        if (job && id == job->id) return *job;
        return refused(Problem{404, "not-found", "Not Found", "There is no job " + id + ".", {}, {}});
    }

    std::variant<std::string, Refused> newest() override {
        return job ? R"({"jobs":[{"id":"7","name":null,"status":")" + job->status + "\"}]}" : R"({"jobs":[]})";
    }

    bool stores_jobs() const override { return stores; }

    std::vector<std::pair<std::string, std::string>> addresses(const std::string& id,
                                                               const std::string& screen) const override {
        return {{"page", "/#/jobs/" + id + "/" + screen}};
    }

    std::optional<ToolJob> job;
    bool stores = false;
};

/// The answers to a text, as a transport would send them.
inline std::string answered(std::string_view text, ToolHost& host) {
    const Incoming incoming = read_messages(text);
    std::vector<std::string> answers;
    for (const auto& part : incoming.parts) {
        const auto* message = std::get_if<Message>(&part);
        answers.push_back(message ? answer(*message, host) : std::get<std::string>(part));
    }
    return joined(incoming, answers);
}

inline Json answer_to(std::string_view method, const Json& params, ToolHost& host) {
    const Json message{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}};
    return Json::parse(answered(message.dump(), host));
}

/// The result of a tool.
inline Json called(const char* tool, const Json& arguments, ToolHost& host) {
    return answer_to("tools/call", {{"name", tool}, {"arguments", arguments}}, host).at("result");
}

inline std::string text_of(const Json& result) { return result.at("content").at(0).at("text").get<std::string>(); }

}  // namespace tunewright::api::mcp
