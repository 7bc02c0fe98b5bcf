// What a user sees of loops around the loop: responses over time, and peaks over frequency.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/structure/cascade.h"
#include "engine/structure/feedforward.h"
#include "engine/structure/interaction.h"
#include "engine/structure/level.h"
#include "engine/structure/predictor.h"

namespace tunewright::structure {

/// Series of equal length; `values[k]` is that of the signal `names[k]`.
struct DrawnResponse {
    std::string of, input;
    std::vector<double> t;
    std::vector<std::string> names;
    std::vector<std::vector<double>> values;
};
struct DrawnCurve {
    std::string of, loop;
    std::optional<double> limit;
    std::vector<double> values;
};
struct StructureDrawing {
    std::vector<DrawnResponse> responses;
    std::vector<double> omega;
    std::vector<DrawnCurve> curves;
};

// `points` of each series, >= 2; of 0 there is no drawing. Responses to one input share their times. What is not stable
// is left out. Names of signals and loops: view.h.

/// `of`: design, single, baseline. `single`, `baseline` null: none.
StructureDrawing draw(const CascadePlants& plants, const CascadeControllers& controllers, const CascadeDesign& limits,
                      const SingleLoop* single, const CascadeControllers* baseline, int points);

/// `of`: design. Of a controller with a gap there is none.
StructureDrawing draw(const LevelProblem& problem, const LevelDesign& design, int points);

/// `of`: the names of the variants that can be built. `limit`: on |S| of the feedback loop.
StructureDrawing draw(const FeedforwardProblem& problem, const FeedforwardResult& result, std::optional<double> limit,
                      int points);

/// Controllers by their names, the design first; `limit`: its limit on mu.
struct NamedControllers {
    std::string name;
    std::vector<IdealPid> controllers;
    Decoupling decoupling = {};
};
StructureDrawing draw(const PlantMatrix& plants, const std::vector<NamedControllers>& controllers, double limit,
                      int points);

/// `of`: design, pid. `pid` null: none. An unstable model has no responses.
StructureDrawing draw(const LinearPlant& plant, const PredictorController& controller, std::optional<double> limit,
                      const IdealPid* pid, int points);

}  // namespace tunewright::structure
