// The figures of one response of loops that are closed together.
#pragma once

#include <vector>

#include "engine/expected.h"
#include "engine/figure.h"

namespace tunewright {
class BlockDiagram;
struct StepResponse;
}  // namespace tunewright

namespace tunewright::structure {

/// Figures of y after a unit step at one signal; TV: of the controller's part of another. Where y comes to rest away
/// from its target, as without integral action, the integrals are infinite and thus not known.
struct StepFigures {
    Figure IAE = 0.0, ISE = 0.0;
    Figure IE = 0.0;  ///< integral of the error
    double TV = 0;
    double peak = 0;       ///< of y, the farther of both sides
    double overshoot = 0;  ///< of y beyond a target that is not 0, as a share of it
    bool settles = true;
};

/// above/below; without a value the reason of the one that has none.
Figure ratio(const Figure& above, const Figure& below);

/// What is measured and moved, and what y should become.
struct SeenStep {
    int y = 0, u = 0;
    double target = 0;
};

/// Errors: those of DiagramResponse::of().
Expected<std::vector<StepFigures>> step_figures(const BlockDiagram& diagram, int enters_at,
                                                const std::vector<SeenStep>& seen);
/// Of one output.
Expected<StepFigures> step_figures(const BlockDiagram& diagram, int enters_at, int y, int u, double target);

/// The same of a response that is known. It rests at its target if it has a final error integral.
StepFigures figures_of(const StepResponse& nodes, double target);

/// The reason for integrals that are infinite.
inline constexpr const char* kRestsElsewhere =
    "The measurement comes to rest away from its target, so the integral of the error is infinite.";

/// The IAE alone, at a lower accuracy: 1e-4, for a search. Infinite also where y comes to rest away from its target.
double quick_IAE(const BlockDiagram& diagram, int enters_at, int y, double target);
/// The same of several outputs that should become 0.
std::vector<double> quick_IAEs(const BlockDiagram& diagram, int enters_at, const std::vector<int>& outputs);

}  // namespace tunewright::structure
