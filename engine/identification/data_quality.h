// What can be said about a record before any model is fitted.
#pragma once

#include <span>

#include "engine/identification/clean_record.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// Sampling, noise, quantisation, changes of u, rows dropped: everything but `settled`, in the record's units. The
/// notes say the same in sentences.
DataQuality describe_record(const CleanRecord& record);

/// Standard deviation of the part of y that changes from sample to sample: second differences, median-based where that
/// is not 0 (a slow response does not count), else root mean square (coarse grids, where most differences are 0).
double noise_std(std::span<const double> y);

/// The step of the grid that all values lie on, 0 if none: steps of a converter or of printed digits. Needs three
/// different values.
double quantisation_step(std::span<const double> y);

}  // namespace tunewright
