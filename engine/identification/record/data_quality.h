// What can be said about a record before any model is fitted.
#pragma once

#include <array>
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

/// Runs of at least five samples (and 1 % of all, over the record) in which y stands exactly at its greatest or least
/// value though it came there at speed (a sixth of its fastest, for some samples) or is noisy elsewhere. A response
/// that settles comes to rest slowly, or at once where the process is fast, and is no saturation. `noise` and `grid`
/// are y's standard deviation from sample to sample and the step that it is rounded to, both dimensionless. The levels
/// are in the record's units.
std::vector<Saturation> flat_tops(const CleanRecord& record, double noise, double grid);

/// Low and high end of u, in the record's units.
using InputLimits = std::array<double, 2>;

/// The usual ends (0 to 1, -1 to 1, 0 to 100, -100 to 100, 0 to 255, -255 to 255, 0 to 1023, 0 to 4095) that a record's
/// u runs beyond by a twentieth of their span and more, in 2 % of the rows and more, while a tenth of the rows lies
/// inside. What reaches the plant is then what lies inside. Not among them are ends below record.u_full_scale, and ends
/// that would hide more than a quarter of the moves between levels on which u stands still: a test made those.
std::vector<InputLimits> plain_limits(const Record& record);

}  // namespace tunewright
