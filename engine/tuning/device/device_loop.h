// An implemented loop, continuous or sampled, with one interface for a search over its settings.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/controller/sampled/sampled_pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/tuning/peak_limits.h"

namespace tunewright::device {

/// A controller with its program's rules; with `Ts` = 0 it is the continuous law of the gains.
using Law = SampledPid;

/// C at omega, by the law's sampled or continuous formula.
std::complex<double> response_of(const Law& law, double omega);

/// The frequencies at which the loop is evaluated: from far below to far above its corners, or up to pi/Ts.
std::vector<double> frequencies_of(const LinearPlant& plant, const Law& law);

bool is_stable(const LinearPlant& plant, const Law& law);

/// Peaks of |S|, |T| and |C S|, each to 1e-8; empty where the loop is not stable.
std::optional<Peaks> stable_peaks(const LinearPlant& plant, const Law& law);

/// The largest relative excess over a limit; infinite where the loop is not stable.
double excess_on(const LinearPlant& plant, const Law& law, const PeakLimits& limits);

/// The integral of |y| after a unit load step; infinite if the loop does not settle.
double load_iae_of(const LinearPlant& plant, const Law& law);

}  // namespace tunewright::device
