#include "engine/structure/drawing/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "engine/blocks/diagram_loop.h"
#include "engine/blocks/diagram_response.h"
#include "engine/structure/drawing/view.h"
#include "engine/structure/search/local_peaks.h"

namespace tunewright::structure {
namespace {

constexpr double kTolerance = 1e-4, kSettled = 3e-3;  // of a drawing
constexpr int kMaxSteps = 20000;
constexpr double kBelowCorners = 0.02, kAboveCorners = 5;

struct Answered {
    const StructureView* view;
    std::vector<DiagramResponse> to;  ///< each input
};

std::optional<Answered> answered(const StructureView& view) {
    if (!count_unstable_poles(view.diagram).stable()) return std::nullopt;
    Answered out{&view, {}};
    for (const NamedSignal& input : view.inputs) {
        auto response = DiagramResponse::of(view.diagram, {{input.signal, view.step}},
                                            {.tolerance = kTolerance, .settled = kSettled, .max_steps = kMaxSteps});
        if (!response) return std::nullopt;
        out.to.push_back(std::move(*response));
    }
    return out;
}

std::vector<double> evenly(double until, int points) {
    std::vector<double> t;
    for (int i = 0; i < points; ++i) t.push_back(until * i / (points - 1));
    return t;
}

void add_responses(const std::vector<Answered>& all, int points, StructureDrawing& out) {
    std::map<std::string, double> until;
    for (const Answered& one : all)
        for (std::size_t i = 0; i < one.to.size(); ++i) {
            double& end = until[one.view->inputs[i].name];
            end = std::max(end, one.to[i].end());
        }
    for (const Answered& one : all)
        for (std::size_t i = 0; i < one.to.size(); ++i) {
            const NamedSignal& input = one.view->inputs[i];
            DrawnResponse drawn{one.view->of, input.name, evenly(until[input.name], points), {}, {}};
            for (const NamedSignal& output : one.view->outputs) {
                drawn.names.push_back(output.name);
                drawn.values.push_back(one.to[i].sampled(output.signal, drawn.t));
            }
            out.responses.push_back(std::move(drawn));
        }
}

/// The frequencies from far below the corners of all blocks to above them.
std::vector<double> frequencies(const std::vector<Answered>& all, int points) {
    std::vector<const LinearPlant*> plants;
    for (const Answered& one : all)
        for (const Block& block : one.view->diagram.blocks()) plants.push_back(&block.plant);
    const std::vector<double> grid =
        frequencies_around(plants, kBelowCorners, kAboveCorners, 1, std::numeric_limits<double>::infinity());
    std::vector<double> out;
    const double ratio = grid.back() / grid.front();
    for (int i = 0; i < points; ++i) out.push_back(grid.front() * std::pow(ratio, double(i) / (points - 1)));
    return out;
}

using Views = std::vector<StructureView>;

/// A view that cannot be made is left out.
void add(Views& views, Expected<StructureView> view) {
    if (view) views.push_back(std::move(*view));
}

StructureDrawing drawing_of(const Views& views, int points) {
    StructureDrawing out;
    if (points < 2) return out;
    std::vector<Answered> all;
    for (const StructureView& view : views)
        if (auto one = answered(view)) all.push_back(std::move(*one));
    if (all.empty()) return out;
    add_responses(all, points, out);
    out.omega = frequencies(all, points);
    for (const Answered& one : all)
        for (const PeakCurve& curve : one.view->curves) {
            DrawnCurve drawn{one.view->of, curve.loop, curve.limit, {}};
            for (const double omega : out.omega) drawn.values.push_back(curve.magnitude(omega));
            out.curves.push_back(std::move(drawn));
        }
    return out;
}

}  // namespace

PeakCurve sensitivity_at(const std::string& loop, const std::shared_ptr<const BlockDiagram>& diagram, int signal,
                         std::optional<double> limit) {
    return {loop, limit, [diagram, signal](double omega) {
                return std::abs(diagram->response({0, omega}, signal)[signal]);
            }};
}

StructureDrawing draw(const CascadePlants& plants, const CascadeControllers& controllers, const CascadeDesign& limits,
                      const SingleLoop* single, const CascadeControllers* baseline, int points) {
    Views views;
    add(views, cascade_view("design", plants, controllers, &limits));
    if (single != nullptr) add(views, single_view(plants, single->controller));
    if (baseline != nullptr) add(views, cascade_view("baseline", plants, *baseline, nullptr));
    return drawing_of(views, points);
}

StructureDrawing draw(const LevelProblem& problem, const LevelDesign& design, int points) {
    Views views;
    if (problem.gap == 0) add(views, level_view(problem, design));
    return drawing_of(views, points);
}

StructureDrawing draw(const FeedforwardProblem& problem, const FeedforwardResult& result, std::optional<double> limit,
                      int points) {
    Views views;
    for (const FeedforwardVariant& variant : result.variants)
        if (variant.why_not.empty()) add(views, feedforward_view(problem, variant, limit));
    // The loop's peak is that of each variant.
    for (std::size_t i = 1; i < views.size(); ++i) views[i].curves.clear();
    return drawing_of(views, points);
}

StructureDrawing draw(const PlantMatrix& plants, const std::vector<NamedControllers>& controllers, double limit,
                      int points) {
    Views views;
    for (const NamedControllers& one : controllers)
        add(views, interaction_view(one.name, plants, one.controllers, one.decoupling,
                                    views.empty() ? std::optional<double>(limit) : std::nullopt));
    return drawing_of(views, points);
}

StructureDrawing draw(const LinearPlant& plant, const PredictorController& controller, std::optional<double> limit,
                      const IdealPid* pid, int points) {
    Views views;
    add(views, predictor_view(plant, controller, limit));
    if (pid != nullptr) add(views, pid_view(plant, *pid));
    return drawing_of(views, points);
}

}  // namespace tunewright::structure
