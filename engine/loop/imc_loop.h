// A plant with the full revised IMC controller over frequency. Computed from plant, model and Q, without C itself:
//
//   D = 1 + (P - G) Q,   S = (1 - G Q)/D,   T = P Q/D,   C S = Q/D.
//
// If the plant equals the model, D = 1 and T is that of the design.
#pragma once

#include <functional>

#include "engine/controller/imc_controller.h"
#include "engine/loop/frequency_grid.h"
#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"

namespace tunewright {

class ImcLoop {
public:
    /// The plant is strictly proper and its poles lie in the open left half-plane (a reduced plant's do).
    ImcLoop(const LinearPlant& plant, const ImcController& controller) : plant_(plant), controller_(controller) {}

    LoopPoint at(double omega) const;
    std::complex<double> characteristic(double omega) const;  ///< D

    /// Plant and Q are stable, so the loop is stable if D does not encircle 0: its argument is followed from 0 to
    /// infinity in steps that are short enough to be unambiguous.
    bool stable() const;

    LoopGrid grid() const;
    Peaks peaks(const LoopGrid& grid) const;  ///< For a stable loop, both ends included.
    Margins margins(const LoopGrid& grid) const;

private:
    double lowest_corner() const;
    double highest_corner() const;

    const LinearPlant& plant_;
    ImcController controller_;
};

}  // namespace tunewright
