// The tools of the Model Context Protocol in the service: their computations take turns, their jobs are stored.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/mcp/tool_host.h"
#include "server/http/message.h"
#include "server/routes/routes.h"

namespace tunewright::server {

/// The parts of the service that the tools use.
struct McpParts {
    JobService& jobs;
    LongRequestSlots& places;
    SharedTurns turns;
    Computations computations;
    api::JobLimits limits;
};

/// The host of one call; both references must outlive it. It sees the jobs that the caller may see.
class McpHost final : public api::mcp::ToolHost {
public:
    McpHost(const McpParts& parts, const http::Request& request) : parts_(parts), request_(request) {}

    std::pair<api::Answer, std::string> compute(const api::mcp::Computation& work) override;
    std::variant<api::mcp::ToolJob, api::mcp::Refused> run(api::PreparedJob job) override;
    std::variant<api::mcp::ToolJob, api::mcp::Refused> find(const std::string& id, bool wait) override;
    std::variant<std::string, api::mcp::Refused> newest() override;
    bool stores_jobs() const override { return true; }
    std::vector<std::pair<std::string, std::string>> addresses(const std::string& id,
                                                               const std::string& screen) const override;
    api::JobLimits limits() const override { return parts_.limits; }

private:
    const McpParts& parts_;
    const http::Request& request_;
};

}  // namespace tunewright::server
