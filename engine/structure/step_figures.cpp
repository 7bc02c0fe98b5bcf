#include "engine/structure/step_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/simulation/linear/indices.h"

namespace tunewright::structure {
namespace {

constexpr double kQuickTolerance = 3e-5, kQuickSettled = 1e-4;

}  // namespace

Expected<StepFigures> step_figures(const BlockDiagram& diagram, int enters_at, int y, int u, double target) {
    const auto response = DiagramResponse::of(diagram, {{enters_at, 1}}, {});
    if (!response) return response.error();
    const StepResponse nodes = response->pair(y, u, target);
    const ErrorIntegrals integrals = error_integrals(nodes.nodes, target, nodes.error_integral_final);
    const Extremes extremes = extremes_of_y(nodes.nodes);
    StepFigures figures{.IAE = integrals.IAE, .ISE = integrals.ISE, .TV = total_variation(nodes.nodes)};
    figures.IE = nodes.error_integral_final.value_or(nodes.nodes.back().error_integral);
    figures.peak = std::abs(extremes.min) > std::abs(extremes.max) ? extremes.min : extremes.max;
    if (target != 0)
        figures.overshoot = std::max(0.0, (target > 0 ? extremes.max : extremes.min) / target - 1);
    figures.settles = nodes.settles;
    return figures;
}

double quick_IAE(const BlockDiagram& diagram, int enters_at, int y, double target) {
    const auto response = DiagramResponse::of(diagram, {{enters_at, 1}},
                                              {.tolerance = kQuickTolerance, .settled = kQuickSettled, .max_steps = 20000});
    if (!response || !response->settles()) return std::numeric_limits<double>::infinity();
    const StepResponse nodes = response->pair(y, y, target);
    return integral_of_absolute_error(nodes.nodes, target, nodes.error_integral_final);
}

}  // namespace tunewright::structure
