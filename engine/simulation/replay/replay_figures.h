// Figures by which two runs of a loop over the same time are compared.
#pragma once

#include <span>

namespace tunewright {

struct ReplayFigures {
    double IAE = 0;            ///< sum of |r - y| h over the rows, y's unit times time
    double largest_error = 0;  ///< max |r - y|, y's unit
    double travel = 0;         ///< sum of |u_k - u_{k-1}|, u's unit
    int reversals = 0;         ///< changes of direction of u, moves back by less than the band left out
};

/// Spans of equal length, rows h > 0 apart. `band` >= 0, in u's unit.
ReplayFigures replay_figures(double h, std::span<const double> r, std::span<const double> y, std::span<const double> u,
                             double band);

}  // namespace tunewright
