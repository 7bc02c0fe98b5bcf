// Jobs and batches as rows of the tables: the one place that knows the order of the columns.
#pragma once

#include <string>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

/// Columns of a summary and of a state, with the tables they come from: "SELECT " + columns + tables.
extern const std::string kSummaryColumns;
extern const std::string kSummaryTables;
/// The same of a record.
extern const std::string kRecordColumns;
extern const std::string kRecordTables;
/// True for jobs that can be seen: those of a batch that is being deleted cannot.
extern const std::string kVisible;

/// From the current row of a query that selects the columns of the same name.
JobSummary read_summary(const Connection::Use& row);
JobState read_state(const Connection::Use& row);
JobRecord read_record(const Connection::Use& row);

/// Columns of a batch, of `batches b`.
extern const std::string kBatchColumns;
BatchSummary read_batch(const Connection::Use& row);

}  // namespace tunewright::server
