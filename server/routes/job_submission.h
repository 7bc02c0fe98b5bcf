// Orders: a request becomes a job, for a client that may wait for its end.
#pragma once

#include <memory>
#include <optional>

#include "server/http/message.h"
#include "server/jobs/service.h"

namespace tunewright::server {

/// The result of an order: the job as accepted and, if the call waited for it and it ended here, as ended.
struct Submitted {
    Submission submission;
    std::shared_ptr<const JobRecord> ended;
};

/// If the order has a wait, creation and wait are one call of the service, so that this thread wakes once. The room of
/// the request is released in between, when the store has answered. Empty if the client has disconnected meanwhile.
std::optional<Submitted> submit(JobService& jobs, Order order, const http::Request& call);

/// The refusal of an order that became no job; empty for a job that was created or existed.
std::optional<http::Response> refuse_submission(const JobService& jobs, const Submission& submission);

/// 429: too many jobs wait, or of this client alone.
http::Response queue_full(const JobService& jobs, bool of_client = false);

}  // namespace tunewright::server
