// Recognises a proportional controller in a rounded log: u is a straight line over y, within the rounding.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant + gain y.
///
/// With u = Kp (r - y) the gain is -Kp in y's range over u's scale (RecordScale), and least squares would give its
/// inverse as the plant: -1/Kp without lag.
struct LevelLaw {
    double gain = 0;  ///< gain from y to u, dimensionless
    double left = 0;  ///< root mean square of the residual of u, dimensionless
};

/// feedback.h examines moves; this examines levels, for records whose moves show nothing.
///
/// Rounding may hide the moves of u and y from row to row, but not their levels. The law is found if
/// - its residual of u is at most 1.5 times that expected from the rounding of both;
/// - it explains u better than y follows u of the previous row, as with a plant that is fast compared with the
///   sampling;
/// - u reverses a dozen times or more, unlike a ramp or a sine of a test.
///
/// `u` is the input at the samples, dimensionless. Empty if u or y has no grid (series.h).
std::optional<LevelLaw> level_law(const CleanRecord& record, const std::vector<double>& u);

}  // namespace tunewright
