// Where the fit starts: from the record itself.
#pragma once

#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// Shapes worth refining, best first, at most `most`. A coarse scan over the dead time (where local minima live) and
/// the time constants, gain and offset eliminated at every point; the local minima of the scan are kept. The record
/// should be thinned out (a few hundred samples).
std::vector<ModelShape> scan_shapes(const FitData& data, const ModelForm& form, int most, std::stop_token stop);

/// Shapes of `structure` that equal or nearly equal the fitted simpler one: a nested model is never fitted worse than
/// the one it contains.
std::vector<ModelShape> extend_shape(const ModelShape& simpler, Structure structure);

}  // namespace tunewright
