// Common parts of all calls about one job or batch: ownership, and answers to failures of the store.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/access/compute_slots.h"
#include "server/http/app/router.h"
#include "server/jobs/service.h"

namespace tunewright::server {

http::Response no_such_job(const std::string& id);
http::Response no_such_batch(const std::string& id);

/// 507 if the disk is full, otherwise 503.
http::Response store_failed(const StoreFault& fault);

/// Runs `work`, which reads the store; a failure of the store becomes an answer.
template <class Work>
http::Response guarded(Work work) {
    try {
        return work();
    } catch (const StoreError& error) {
        return store_failed({error.kind, error.what()});
    }
}

/// Runs `work`, which reads a whole job and answers with it, when the client's turn has come: a job may have tens of
/// megabytes, several times while its answer is made. The turn ends when the answer counts as unsent.
http::Response in_turn(ComputeSlots& readers, const http::Request& request,
                       const std::function<http::Response()>& work);

/// The owner whose jobs the caller may see; empty for all jobs, if no keys are required or the caller is an
/// administrator.
std::optional<std::string> visible_owner(const http::Request& request);

/// True if the caller may see the job, or the batch.
bool may_see(const http::Request& request, const JobSummary& job);
bool may_see(const http::Request& request, const BatchSummary& batch);

/// The refusal of a call about /v1/jobs/{id} if this caller has no such job. Owners never change.
std::optional<http::Response> refuse_stranger(JobService& jobs, const http::Call& call);

}  // namespace tunewright::server
