// What reading a record has found, as a part of the answer about it.
#pragma once

#include "api/contract/record.h"

namespace tunewright::api {

/// What reading the CSV has found belongs to the data's quality too.
void add_reading(const ReadRecord& read, IdentifiedModel& model);

/// Traces are answered only where they were asked for.
void leave_out_traces(const IdentifyQuestion& question, IdentifiedModel& model);

}  // namespace tunewright::api
