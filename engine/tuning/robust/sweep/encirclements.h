// How often the Nyquist curve of k L goes around -1, for every factor k at once: by its crossings of the negative real
// axis, from the values on a grid.
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

    /// Crossings upward less those downward, to the left of -1: with those below the grid they are the clockwise turns
    /// around -1 (Nyquist 1932), half the unstable poles that k L adds to its own when the loop is closed. Empty where
    /// neighbours lie too far apart to say.
    std::optional<int> beyond(double k) const;

private:
    struct Crossing {
        double factor;  ///< that puts it on -1
        int upward;
    };
    std::vector<Crossing> crossings_;
    double doubtful_from_ = std::numeric_limits<double>::infinity();  // factor
};

/// The phase of P(jw) over that of its low-frequency gain, followed from w = 0 and from 0 just beside integrators.
/// Empty for a plant with a zero at rest, or with poles on the axis other than integrators.
std::optional<double> phase_from_rest(const LinearPlant& plant, double omega);

}  // namespace tunewright::robust
