#include "server/cli/local_tool_host.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "server/clock.h"
#include "server/config.h"
#include "server/http/app/problems.h"
#include "server/json_text.h"
#include "server/threads/spare_cores.h"
#include "server/threads/timer.h"

namespace tunewright::server {
namespace {

using api::mcp::Refused;
using api::mcp::ToolJob;

constexpr double kComputeTime = 60;              // s
constexpr std::size_t kMaxKept = 50;             // answers
constexpr std::size_t kMaxKeptBytes = 64 << 20;  // of all kept answers

std::string stopped_after(double limit_s) {
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = "The computation was stopped after " + std::to_string(static_cast<int>(limit_s)) +
                    " s. Reduce the request, or run it with the command line or as a job of the service.";
    return api::to_json(api::to_problem(error));
}

}  // namespace

bool LocalToolHost::controlled(double limit_s, const std::function<void(const RunControl&)>& work) const {
    std::stop_source source;
    std::atomic<bool> late = false;
    const std::stop_callback on_cancel(stop_, [&source] { source.request_stop(); });
    Timer timer;
    timer.after(std::chrono::duration<double>(limit_s), [&] {
        late = true;
        source.request_stop();
    });
    SpareCores cores(core_count());
    SpareCores::Computation computation(cores);
    RunControl control;
    control.stop = source.get_token();
    control.now_ms = monotonic_ms;
    control.spread = computation.spread();
    work(control);
    timer.stop();
    return late;
}

std::pair<api::Answer, std::string> LocalToolHost::compute(const api::mcp::Computation& work) {
    api::Answer answer;
    const bool late = controlled(kComputeTime, [&](const RunControl& control) { answer = work(control); });
    if (answer.status >= 400) {
        if (late) answer.body = stopped_after(kComputeTime);
        return {std::move(answer), ""};
    }
    std::string id = keep({{"", "succeeded", "", answer.body, "", ""}, "", ""});
    return {std::move(answer), std::move(id)};
}

std::variant<ToolJob, Refused> LocalToolHost::run(api::PreparedJob job) {
    api::JobOutcome outcome;
    const bool late = controlled(job.timeout_s, [&](const RunControl& control) {
        outcome = api::run_job(api::StoredRequest{job.request_json, job.request_hash}, control);
    });
    if (outcome.result_json.empty())
        return Refused{outcome.error_json.empty() || late ? stopped_after(job.timeout_s)
                                                          : std::move(outcome.error_json)};
    const char* status = outcome.status == api::JobOutcome::Status::succeeded ? "succeeded" : "cancelled";
    ToolJob made{"", status, std::move(job.request_json), std::move(outcome.result_json), "", ""};
    made.id = keep({made, std::move(job.name), std::move(outcome.outline_json)});
    return made;
}

std::string LocalToolHost::keep(KeptAnswer answer) {
    const std::lock_guard lock(mutex_);
    answer.job.id = std::to_string(++count_);
    bytes_ += answer.bytes();
    kept_.push_back(std::move(answer));
    std::string id = kept_.back().job.id;
    while (!kept_.empty() && (kept_.size() > kMaxKept || bytes_ > kMaxKeptBytes)) {
        bytes_ -= kept_.front().bytes();
        kept_.pop_front();
    }
    return id;
}

std::variant<ToolJob, Refused> LocalToolHost::find(const std::string& id, bool) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(kept_, [&](const KeptAnswer& each) { return each.job.id == id; });
    if (found != kept_.end()) return found->job;
    const std::string which =
        kept_.empty() ? "none yet"
                      : kept_.front().job.id + " to " + kept_.back().job.id + ", the latest of this process";
    return api::mcp::refused(http::problem(404, "There is no job " + id.substr(0, 64) + "; there are " + which + "."));
}

std::variant<std::string, Refused> LocalToolHost::newest() {
    const std::lock_guard lock(mutex_);
    std::string list;
    for (auto each = kept_.rbegin(); each != kept_.rend(); ++each) {
        JsonObject object;
        object.text("id", each->job.id).text("status", each->job.status);
        if (!each->name.empty()) object.text("name", each->name);
        if (!each->outline.empty()) object.raw("outline", each->outline);
        list += (list.empty() ? "" : ",") + std::move(object).str();
    }
    return "{\"jobs\":[" + list + "]}";
}

}  // namespace tunewright::server
