#include "engine/structure/step_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/blocks/diagram_response.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright::structure {
namespace {

constexpr double kQuickTolerance = 3e-6, kQuickSettled = 3e-5;

std::vector<double> quick_IAEs_of(const BlockDiagram& diagram, int enters_at, const std::vector<int>& outputs,
                                  double target) {
    const auto response = DiagramResponse::of(
        diagram, {{enters_at, 1}}, {.tolerance = kQuickTolerance, .settled = kQuickSettled, .max_steps = 20000});
    std::vector<double> out(outputs.size(), std::numeric_limits<double>::infinity());
    if (!response || !response->settles()) return out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const StepResponse nodes = response->pair(outputs[i], outputs[i], target);
        if (nodes.error_integral_final)
            out[i] = integral_of_absolute_error(nodes.nodes, target, nodes.error_integral_final);
    }
    return out;
}

}  // namespace

Figure ratio(const Figure& above, const Figure& below) {
    if (!above || !below) return no_figure(below ? above.why : below.why);
    return finite_or(*above / *below, "It is divided by 0.");
}

StepFigures figures_of(const StepResponse& nodes, double target) {
    const Extremes extremes = extremes_of_y(nodes.nodes);
    StepFigures figures{.TV = total_variation(nodes.nodes)};
    if (nodes.error_integral_final) {
        const ErrorIntegrals integrals = error_integrals(nodes.nodes, target, nodes.error_integral_final);
        figures.IAE = integrals.IAE;
        figures.ISE = integrals.ISE;
        figures.IE = *nodes.error_integral_final;
    } else {
        figures.IAE = figures.ISE = figures.IE =
            no_figure(nodes.settles ? kRestsElsewhere : "The response does not come to rest.");
    }
    figures.peak = std::abs(extremes.min) > std::abs(extremes.max) ? extremes.min : extremes.max;
    if (target != 0) figures.overshoot = std::max(0.0, (target > 0 ? extremes.max : extremes.min) / target - 1);
    figures.settles = nodes.settles;
    return figures;
}

Expected<std::vector<StepFigures>> step_figures(const BlockDiagram& diagram, int enters_at,
                                                const std::vector<SeenStep>& seen) {
    const auto response = DiagramResponse::of(diagram, {{enters_at, 1}}, {});
    if (!response) return response.error();
    std::vector<StepFigures> out;
    for (const SeenStep& one : seen) out.push_back(figures_of(response->pair(one.y, one.u, one.target), one.target));
    return out;
}

Expected<StepFigures> step_figures(const BlockDiagram& diagram, int enters_at, int y, int u, double target) {
    auto figures = step_figures(diagram, enters_at, {{y, u, target}});
    if (!figures) return figures.error();
    return figures->front();
}

double quick_IAE(const BlockDiagram& diagram, int enters_at, int y, double target) {
    return quick_IAEs_of(diagram, enters_at, {y}, target).front();
}

std::vector<double> quick_IAEs(const BlockDiagram& diagram, int enters_at, const std::vector<int>& outputs) {
    return quick_IAEs_of(diagram, enters_at, outputs, 0);
}

}  // namespace tunewright::structure
