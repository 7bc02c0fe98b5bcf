// What all calls about one job have in common: whom it belongs to, and what a store that fails is answered with.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/access/compute_slots.h"
#include "server/http/app/router.h"
#include "server/jobs/service.h"

namespace tunewright::server {

http::Response no_such_job(const std::string& id);

/// 507 where the disk is full, else 503.
http::Response store_failed(const StoreFault& fault);

/// Runs what reads the store; its failure becomes such an answer.
template <class Work>
http::Response guarded(Work work) {
    try {
        return work();
    } catch (const StoreError& error) {
        return store_failed({error.kind, error.what()});
    }
}

/// Runs `work`, which reads a job as a whole and answers with it, when the client's turn has come: a job may have tens
/// of megabytes, several times over while its answer is made. The turn ends when the answer counts among those that
/// clients have not taken.
http::Response in_turn(ComputeSlots& readers, const http::Request& request,
                       const std::function<http::Response()>& work);

/// Whose jobs the caller may know of: nothing for everybody's, where nobody asks who he is or he runs the service.
std::optional<std::string> visible_owner(const http::Request& request);

/// True where the caller may know of the job.
bool may_see(const http::Request& request, const JobSummary& job);

/// The refusal of a call about /v1/jobs/{id} where there is no such job for this caller. Owners never change.
std::optional<http::Response> refuse_stranger(JobService& jobs, const http::Call& call);

}  // namespace tunewright::server
