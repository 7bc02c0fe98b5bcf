// The description of a record before any model is fitted.
#pragma once

#include <array>
#include <vector>

#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// All figures except `settled`, `closed_loop` and `u_limits`, in the record's units. The notes state the same in
/// sentences, with what was done.
DataQuality describe_record(const CleanRecord& record);

/// Warnings that affect the model:
/// - saturated-output: y is constant at its largest or smallest value;
/// - gaps, missing-samples: nothing, or no y, was recorded for a part of the record;
/// - removed-outliers: physically impossible readings were removed;
/// - reversed-time, misplaced-times: rows out of order;
/// - few-samples: fewer than 30;
/// - columns-look-swapped: y stays on few levels while u moves from sample to sample.
///
/// `quality` is the record's own, by describe_record().
std::vector<Warning> record_warnings(const CleanRecord& record, const DataQuality& quality);

/// Runs of at least five samples (and 1 % of all, over the record) in which y is exactly at its largest or smallest
/// value although it arrived there fast (with a sixth of its largest speed, for some samples) or is noisy elsewhere. A
/// settling response comes to rest slowly, or at once if the process is fast, and is not a saturation. `noise` and
/// `grid` are y's standard deviation from sample to sample and the step that it is rounded to, both dimensionless. The
/// levels are in the record's units.
std::vector<Saturation> flat_tops(const CleanRecord& record, double noise, double grid);

/// Low and high end of u, in the record's units.
using InputLimits = std::array<double, 2>;

/// The usual ends (0 to 1, -1 to 1, 0 to 100, -100 to 100, 0 to 255, -255 to 255, 0 to 1023, 0 to 4095) that a record's
/// u exceeds by at least a twentieth of their span, in at least 2 % of the rows, while a tenth of the rows lies inside.
/// The plant's input is then u limited to them. Excluded are ends below record.u_full_scale, and ends that would hide
/// more than a quarter of the moves between levels at which u is constant, because a test made those.
std::vector<InputLimits> plain_limits(const Record& record);

}  // namespace tunewright
