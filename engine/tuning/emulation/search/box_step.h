// The step of a Gauss-Newton iteration inside a box, exactly.
#pragma once

#include <optional>
#include <vector>

namespace tunewright::emulation {

/// Minimises g.d + d.H d/2 subject to low <= d <= high, by trying every set of active bounds. H is n x n, row by row,
/// positive definite; low <= 0 <= high. At most four unknowns.
std::vector<double> best_step_in_box(const std::vector<double>& H, const std::vector<double>& g,
                                     const std::vector<double>& low, const std::vector<double>& high);

}  // namespace tunewright::emulation
