// A plant with the full revised IMC controller over frequency. Computed from plant, model and Q, without C itself:
//
//   D = 1 + (P - G) Q,   S = (1 - G Q)/D,   T = P Q/D,   C S = Q/D.
//
// If the plant equals the model, D = 1 and T is that of the design.
#pragma once

#include <algorithm>

#include "engine/controller/imc_controller.h"
#include "engine/loop/frequency_loop.h"

namespace tunewright {

class ImcLoop {
public:
    /// The plant is strictly proper and its poles lie in the open left half-plane (a reduced plant's do).
    ImcLoop(const LinearPlant& plant, const ImcController& controller) : plant_(plant), controller_(controller) {}

    LoopPoint at(double omega) const;
    std::complex<double> characteristic(double omega) const;  ///< D
    LoopGrid ends() const;
    double turning_time() const { return plant_.dead_time(); }
    double longest_dead_time() const { return std::max(plant_.dead_time(), controller_.theta); }

    struct Band {
        double low, high;
    };
    Band band() const;  ///< from far below to far above the corners of plant, model and Q

private:
    const LinearPlant& plant_;
    ImcController controller_;
};

LoopGrid make_loop_grid(const ImcLoop& loop);

/// With stable plant and Q the loop is stable if D does not encircle 0. Follows the change of D's argument from 0 to
/// infinity, in steps so short that it is unambiguous.
StabilityCount count_unstable_poles(const ImcLoop& loop);

}  // namespace tunewright
