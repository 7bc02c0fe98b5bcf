// The number of encirclements of -1 by the Nyquist curve of k L, for every factor k at once: from the crossings of the
// negative real axis, by the values on a grid.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright::robust {

class AxisCrossings {
public:
    /// L at ascending frequencies.
    AxisCrossings(std::span<const double> L_re, std::span<const double> L_im);

    /// Upward minus downward crossings to the left of -1: together with those below the grid they are the clockwise
    /// turns around -1 (Nyquist 1932), half the unstable poles that k L adds to its own when the loop is closed. Empty
    /// if neighbours are too far apart to decide.
    std::optional<int> beyond(double k) const;

private:
    struct Crossing {
        double factor;  ///< factor that moves the crossing to -1
        int upward;
    };
    std::vector<Crossing> crossings_;
    double doubtful_from_ = std::numeric_limits<double>::infinity();  // factor
};

/// The phase of P(jw) over that of its low-frequency gain, followed from w = 0, where it is 0 (next to the
/// integrators). Empty for a plant with a zero at s = 0, or with poles on the axis other than integrators.
std::optional<double> phase_from_rest(const LinearPlant& plant, double omega);

}  // namespace tunewright::robust
