// Starts of the search for a model's shape: from the record itself, and from fits of simpler structures.
#pragma once

#include <stop_token>
#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// Shapes of `form` worth refining, best first, at most `max`; dimensionless. A coarse scan over the dead time (in
/// which the local minima lie), the time constants and the time of a load, gain and offset eliminated at every point;
/// the local minima of the scan are kept. The record should be thinned out (thin_out(), a few hundred samples).
///
/// Empty for the widest structures (third, ipdt_second), and for a load together with a second order: these start only
/// from fits of simpler structures. A scan that is stopped keeps its results so far.
///
/// Cost: one projection of gain and offset for each point, from a dozen points (ipdt) to some thousand (a lag, a dead
/// time and the time of a load).
std::vector<ModelShape> scan_shapes(const FitData& data, const ModelForm& form, int max, const std::stop_token& stop);

/// Shapes of `structure` that equal or nearly equal the fitted simpler one, the nearest first: a model is never fitted
/// worse than one that it contains. Empty if `structure` does not contain the simpler one:
///
///   fopdt in sopdt and sopdt_zero; sopdt in sopdt_zero and third; ipdt in ipdt_lag; ipdt_lag in ipdt_second.
///
/// The dead time, the lags and the load's time keep the units of `simpler`. A new lag starts near 0, and from shares of
/// the dead time and of the other lags, which are shortened accordingly; the record is not used.
std::vector<ModelShape> extend_shape(const ModelShape& simpler, Structure structure);

}  // namespace tunewright
