// A proportional controller in a log that is rounded: u is a straight line over y, as far as the figures tell.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant + gain y.
///
/// With u = Kp (r - y) the gain is -Kp in y's range over u's scale (RecordScale), and the plant that least squares
/// would answer is its inverse: -1/Kp, at once.
struct LevelLaw {
    double gain = 0;  ///< dimensionless u over y
    double left = 0;  ///< root mean square of what it leaves of u, dimensionless
};

/// feedback.h looks at moves; this is what is left where they show nothing.
///
/// Rounding drowns the moves of u and y from row to row, but not their levels. The law is found where
/// - it explains u within half more than the rounding of both does;
/// - it does so better than u of the row before goes with y, as behind a plant that is quick beside the rows;
/// - u turns back a dozen times and more, as no ramp or sine of a test does.
///
/// `u` is the input at the samples, dimensionless. Empty where u or y lies on no grid (series.h).
std::optional<LevelLaw> level_law(const CleanRecord& record, const std::vector<double>& u);

}  // namespace tunewright
