// Reads, one statement each.
#pragma once

#include <string>
#include <vector>

#include "server/store/postgres/session.h"
#include "server/store/store.h"

namespace tunewright::server::postgres {

std::optional<JobRecord> find_record(Session& session, const std::string& id);
std::vector<JobState> find_states(Session& session, const std::vector<std::string>& ids);
JobPage list_jobs(Session& session, const JobQuery& query);
JobStore::Depth count_waiting(Session& session);
std::optional<BatchSummary> find_batch(Session& session, const std::string& id);
std::optional<std::string> find_batch_of_key(Session& session, const std::string& owner, const std::string& key);
BatchPage list_batches(Session& session, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq);
std::vector<BatchRow> find_rows(Session& session, const std::string& batch, std::int64_t from, std::size_t limit);

}  // namespace tunewright::server::postgres
