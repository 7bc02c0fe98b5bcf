#include "server/routes/job_access.h"

#include <chrono>
#include <memory>

#include "server/http/app/problems.h"
#include "server/routes/request_checks.h"

namespace tunewright::server {

using http::problem_response;
using http::Response;

Response no_such_job(const std::string& id) {
    return problem_response(404, "There is no job " + id.substr(0, 64) + "; it may have been deleted.");
}

Response no_such_batch(const std::string& id) {
    return problem_response(404, "There is no batch " + id.substr(0, 64) + "; it may have been deleted.");
}

Response store_failed(const StoreFault& fault) {
    if (fault.kind == StoreFault::Kind::full)
        return problem_response(507,
                                "The disk of the service is full; nothing was kept. Try again when there is room.");
    if (fault.kind == StoreFault::Kind::unknown)
        return problem_response(
            503,
            "The connection to the store was lost during the commit, so it is not known whether this was stored. Look "
            "it up, or send it again with the same Idempotency-Key, which prevents a second one.");
    return problem_response(503,
                            "The store of the service is not available at the moment; nothing was changed. Try again.");
}

Response in_turn(ComputeSlots& readers, const http::Request& request, const std::function<Response()>& work) {
    constexpr std::chrono::seconds longest{10};
    switch (readers.take(request.client, ComputeSlots::Clock::now() + longest, request.left)) {
        case ComputeSlots::Wait::full:
        case ComputeSlots::Wait::late:
            return problem_response(503, "Too many jobs are being read. Try again in a moment.");
        case ComputeSlots::Wait::left: return client_gone();
        case ComputeSlots::Wait::granted: break;
    }
    const std::shared_ptr<void> turn(nullptr,
                                     [&readers, client = request.client](void*) { readers.give_back(client); });
    Response response = guarded(work);
    response.turn = turn;
    return response;
}

std::optional<std::string> visible_owner(const http::Request& request) {
    return request.admin ? std::nullopt : request.owner;
}

bool may_see(const http::Request& request, const JobSummary& job) {
    const std::optional<std::string> owner = visible_owner(request);
    return !owner || *owner == job.owner;
}

bool may_see(const http::Request& request, const BatchSummary& batch) {
    const std::optional<std::string> owner = visible_owner(request);
    return !owner || *owner == batch.owner;
}

std::optional<Response> refuse_stranger(JobService& jobs, const http::Call& call) {
    if (!visible_owner(call.request)) return std::nullopt;
    const std::string& id = call.path.at("id");
    Response found = guarded([&] {
        const std::optional<JobState> state = jobs.state(id);
        return state && may_see(call.request, *state) ? Response() : no_such_job(id);
    });
    if (found.status == 200) return std::nullopt;
    return found;
}

}  // namespace tunewright::server
