// A job as the contract shows it.
#pragma once

#include <string>

#include "server/jobs/service.h"

namespace tunewright::server {

/// With request, and result or error.
std::string job_json(const JobView& view);

/// The same without request and result.
std::string job_news_json(const JobView& view);

/// The contract's progress object, of a job that waits or has just begun too; null of one that has ended.
std::string job_progress_json(const JobView& view);

/// {"jobs": [...], "next": "/v1/jobs?..." or null}: without requests and results.
std::string job_page_json(const JobPage& page, const JobQuery& query);

/// The opaque place in the list that `cursor` names; nothing where it is none of ours.
std::optional<std::int64_t> parse_cursor(const std::string& cursor);

}  // namespace tunewright::server
