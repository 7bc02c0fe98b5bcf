// Jobs and batches in the form of the contract.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/service.h"
#include "server/store/store.h"

namespace tunewright::server {

/// A job with its request, and its result or error.
std::string job_json(const JobView& view);

/// A job without request and result.
std::string job_news_json(const JobView& view);

/// The job without the samples of its record and without the traces of its result, which may be megabytes.
JobRecord without_traces(JobRecord job);

/// A job with request and result but without traces: the content of a notification.
std::string notification_job_json(JobRecord job);

/// The contract's progress object, also for a job that waits or has just begun; null for one that has ended.
std::string job_progress_json(const JobView& view);

/// {"jobs": [...], "next": "/v1/jobs?..." or null}: jobs without requests and results; for an administrator with their
/// owners.
std::string job_page_json(const JobPage& page, const JobQuery& query, bool with_owners);

/// `notes`: findings about its files, which only the answer to the call that posted it has.
std::string batch_json(const BatchSummary& batch, const std::vector<std::string>& notes = {});

/// {"batches": [...], "next": "/v1/batches?..." or null}.
std::string batch_page_json(const BatchPage& page, int limit);

/// The position that `cursor` names in a list; empty for a text that no list has returned.
std::optional<std::int64_t> parse_cursor(const std::string& cursor);

}  // namespace tunewright::server
