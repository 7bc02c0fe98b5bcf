// How jobs and batches stand in the tables' rows: the one place that knows the order of the columns.
#pragma once

#include <pqxx/row>
#include <string>

#include "server/store/store.h"

namespace tunewright::server::postgres {

/// Columns of a summary and of a state, with the tables they come from: "SELECT " + columns + tables.
extern const std::string kSummaryColumns;
extern const std::string kTables;
/// The same of a record, from the same tables.
extern const std::string kRecordColumns;
/// True for jobs that can be seen: those of a batch that is being deleted cannot.
extern const std::string kVisible;

JobSummary read_summary(const pqxx::row& row);
JobState read_state(const pqxx::row& row);
JobRecord read_record(const pqxx::row& row);

/// "SELECT " + these + conditions on `b` + kBatchGroups.
extern const std::string kBatchColumns;
extern const std::string kBatchTables;
extern const std::string kBatchGroups;
BatchSummary read_batch(const pqxx::row& row);

/// "" where it is null.
std::string text_of(const pqxx::field& field);

}  // namespace tunewright::server::postgres
