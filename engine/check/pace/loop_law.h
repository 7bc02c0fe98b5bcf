// The controller's gain and integral time from the record, roughly: enough to tell how quick the loop is.
#pragma once

#include <limits>
#include <span>

namespace tunewright::check {

/// u(t) - u(t - M) = gain (e(t) - e(t - M) + integral of e over these rows / Ti), by least squares, M from 1 to 30
/// rows: differences over several rows bear rounding of the output. identification/controller_law finds the settings
/// themselves, with errors, and takes a hundred times as long.
struct LoopLaw {
    double gain = 0;                                      ///< u/y, with the sign of the controller's
    double Ti = std::numeric_limits<double>::infinity();  ///< time; infinite without integral action
    double explained = 0;                 ///< of the variance of these differences of u, 0 to 1; 1 for a given law
    double gain_error = 0, Ti_error = 0;  ///< standard errors, relative
    bool given = false;                   ///< by the user, not fitted
};

LoopLaw loop_law(std::span<const double> error, std::span<const double> output, double step);

}  // namespace tunewright::check
