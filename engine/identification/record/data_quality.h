// What can be said about a record before any model is fitted.
#pragma once

#include <vector>

#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// Everything but `settled`, `closed_loop` and `u_limits`, in the record's units. The notes say the same in sentences,
/// and what was done about each.
DataQuality describe_record(const CleanRecord& record);

/// Warnings that affect the model:
/// - saturated-output: y stands at its greatest or least value;
/// - gaps, missing-samples: nothing, or no y, was recorded for a part of the record;
/// - removed-outliers: readings that no process makes were left out;
/// - reversed-time, misplaced-times: rows out of order;
/// - few-samples: fewer than 30;
/// - columns-look-swapped: y stays on few levels while u moves from sample to sample.
///
/// `quality` is the record's own, by describe_record().
std::vector<Warning> record_warnings(const CleanRecord& record, const DataQuality& quality);

}  // namespace tunewright
