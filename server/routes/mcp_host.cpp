#include "server/routes/mcp_host.h"

#include <chrono>
#include <optional>

#include "server/jobs/await.h"
#include "server/routes/job_access.h"
#include "server/routes/job_json.h"
#include "server/routes/job_submission.h"
#include "server/routes/request_checks.h"

namespace tunewright::server {
namespace {

using api::mcp::Refused;
using api::mcp::ToolJob;

constexpr std::chrono::seconds kComputeTime{30};
// Clients of the protocol give up after a minute; a longer job is asked for with job_status.
constexpr std::chrono::seconds kWait{20};
constexpr int kNewest = 20;

Refused refused_by(http::Response response) { return {std::move(response.body)}; }

ToolJob tool_job(JobView view) {
    const std::string progress = job_progress_json(view);
    JobRecord job = without_traces(std::move(view.job));
    return {job.id,
            std::string(to_string(job.status)),
            std::move(job.request),
            std::move(job.result),
            std::move(job.error),
            progress};
}

}  // namespace

std::pair<api::Answer, std::string> McpHost::compute(const api::mcp::Computation& work) {
    http::Response response = parts_.computations.answer(request_, kComputeTime, work);
    return {{response.status, std::move(response.body)}, ""};
}

std::variant<ToolJob, Refused> McpHost::run(api::PreparedJob job) {
    Order order;
    order.job = std::move(job);
    order.owner = request_.owner.value_or("");
    order.flow = request_.client;
    order.origin = {request_.request_id, request_.traceparent};
    const auto place = parts_.places.take(request_.client);
    if (place) order.wait = kWait;
    auto made = submit(parts_.jobs, std::move(order), request_);
    if (!made) return refused_by(client_gone());
    if (auto refusal = refuse_submission(parts_.jobs, made->submission)) return refused_by(*std::move(refusal));
    if (made->ended) return tool_job({*made->ended, std::nullopt});
    return find(made->submission.job.id, false);
}

std::variant<ToolJob, Refused> McpHost::find(const std::string& id, bool wait) {
    std::variant<ToolJob, Refused> found;
    http::Response response = guarded([&] {
        const std::optional<JobState> state = parts_.jobs.state(id);
        if (!state || !may_see(request_, *state)) return no_such_job(id);
        const auto place = wait && !has_ended(state->status) ? parts_.places.take(request_.client) : std::nullopt;
        const auto wait_for_end = [&](const std::function<void()>& ended) {
            parts_.jobs.wait(id, kWait, [ended](const auto&) { ended(); });
        };
        if (place && !await_end(wait_for_end, request_.left)) return client_gone();
        return in_turn(parts_.turns.readers, request_, [&] {
            std::optional<JobView> view = parts_.jobs.find(id);
            if (!view) return no_such_job(id);
            found = tool_job(*std::move(view));
            return http::Response();
        });
    });
    if (response.status != 200) found = refused_by(std::move(response));
    return found;
}

std::variant<std::string, Refused> McpHost::newest() {
    http::Response response = in_turn(parts_.turns.listers, request_, [&] {
        JobQuery query;
        query.owner = visible_owner(request_);
        query.limit = kNewest;
        return http::json_response(job_page_json(parts_.jobs.list(query), query, false));
    });
    if (response.status != 200) return refused_by(std::move(response));
    return std::move(response.body);
}

std::vector<std::pair<std::string, std::string>> McpHost::addresses(const std::string& id,
                                                                    const std::string& screen) const {
    return {{"api", "/v1/jobs/" + id}, {"page", "/#/jobs/" + id + "/" + screen}};
}

}  // namespace tunewright::server
