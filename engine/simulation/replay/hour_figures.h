// How a loop has done over a record: the figures that two runs of the same hour are compared by.
#pragma once

#include <span>

namespace tunewright {

struct HourFigures {
    double IAE = 0;            ///< sum of |r - y| h over the rows, y's unit times time
    double largest_error = 0;  ///< max |r - y|, y's unit
    double travel = 0;         ///< sum of |u_k - u_{k-1}|, u's unit
    int reversals = 0;         ///< changes of direction of u, moves back by less than the band left out
};

/// Spans of equal length. `band` >= 0, in u's unit: as a valve with so much play counts.
HourFigures hour_figures(double h, std::span<const double> r, std::span<const double> y, std::span<const double> u,
                         double band);

}  // namespace tunewright
