// What can be said about a record before any model is fitted.
#pragma once

#include <span>

#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// Everything but `settled`, in the record's units. The notes say the same in sentences, and what was done about each.
DataQuality describe_record(const CleanRecord& record);

/// Warnings that affect the model. Codes: saturated-output, gaps, missing-samples,
/// removed-outliers, reversed-time, misplaced-times, few-samples, columns-look-swapped.
std::vector<Warning> record_warnings(const CleanRecord& record, const DataQuality& quality);

/// Standard deviation of the part of y that changes from sample to sample: second differences, median-based where that
/// is not 0 (a slow response does not count), else root mean square (coarse grids, where most differences are 0).
double noise_std(std::span<const double> y);

/// The step of the grid that all values lie on, 0 if none: steps of a converter or of printed digits; with two
/// different values the distance between them.
double quantisation_step(std::span<const double> y);

/// Runs of at least five samples (and 1 % of all, over the record) in which y stands exactly at its greatest or least
/// value though it came there at speed (a sixth of its fastest, for some samples) or is noisy elsewhere. A response
/// that settles comes to rest slowly, or at once where the process is fast, and is none.
std::vector<Saturation> flat_tops(const CleanRecord& record, double noise, double grid);

}  // namespace tunewright
