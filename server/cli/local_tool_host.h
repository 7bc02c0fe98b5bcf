// The tools of the Model Context Protocol in a process of its own: it computes on all cores and keeps the latest
// answers in memory.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/mcp/tool_host.h"

namespace tunewright::server {

/// One computation at a time; find() and newest() may be called by another thread meanwhile.
class LocalToolHost final : public api::mcp::ToolHost {
public:
    /// The next computations stop when `stop` asks for it.
    void stop_with(std::stop_token stop) { stop_ = std::move(stop); }

    std::pair<api::Answer, std::string> compute(const api::mcp::Computation& work) override;
    std::variant<api::mcp::ToolJob, api::mcp::Refused> run(api::PreparedJob job) override;
    std::variant<api::mcp::ToolJob, api::mcp::Refused> find(const std::string& id, bool wait) override;
    std::variant<std::string, api::mcp::Refused> newest() override;
    bool stores_jobs() const override { return false; }
    std::vector<std::pair<std::string, std::string>> addresses(const std::string&, const std::string&) const override {
        return {};
    }

private:
    struct KeptAnswer {
        api::mcp::ToolJob job;
        std::string name, outline;  ///< "" if there is none
        std::size_t bytes() const { return job.request.size() + job.result.size() + outline.size(); }
    };

    /// Calls `work` with a control that stops after `limit_s`; true if that limit was reached.
    bool controlled(double limit_s, const std::function<void(const RunControl&)>& work) const;
    /// Keeps an answer and drops the oldest beyond the limits; returns its id.
    std::string keep(KeptAnswer answer);

    std::stop_token stop_;
    std::mutex mutex_;
    std::deque<KeptAnswer> kept_;
    std::size_t count_ = 0, bytes_ = 0;
};

}  // namespace tunewright::server
