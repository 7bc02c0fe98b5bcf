// Loops around the loop as block diagrams with the names of what is shown of them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/blocks/block_diagram.h"
#include "engine/callable.h"
#include "engine/structure/cascade.h"
#include "engine/structure/feedforward.h"
#include "engine/structure/interaction.h"
#include "engine/structure/level.h"
#include "engine/structure/predictor.h"

namespace tunewright::structure {

struct NamedSignal {
    std::string name;
    int signal = 0;
};

/// A magnitude over frequency: |S| of one loop, or mu.
struct PeakCurve {
    std::string loop;
    std::optional<double> limit;
    Callable<double(double omega)> magnitude;
};

/// |S| of the loop broken at a signal.
PeakCurve sensitivity_at(const std::string& loop, const std::shared_ptr<const BlockDiagram>& diagram, int signal,
                         std::optional<double> limit);

/// Loops with their controllers, and the names of what is shown of them.
struct StructureView {
    std::string of;  ///< "design", or what it is compared with: "single", "pid", "none"
    BlockDiagram diagram;
    std::vector<NamedSignal> inputs, outputs;
    double step = 1;  ///< size of the step at each input
    std::vector<PeakCurve> curves;
};

// The views of each structure. Errors: those of the block diagram.

/// Inputs setpoint, outer_load, inner_load; outputs y1, y2, u; loops inner, outer, valve. `limits` null: none. Error:
/// unsupported if the inner loop by itself is not stable.
Expected<StructureView> cascade_view(const std::string& of, const CascadePlants& plants,
                                     const CascadeControllers& controllers, const CascadeDesign* limits);
/// The same without an inner loop; loop valve. No limit.
Expected<StructureView> single_view(const CascadePlants& plants, const IdealPid& controller);

/// Input inflow, a step of the largest size; outputs level and outflow; loop level. A gap is left out.
Expected<StructureView> level_view(const LevelProblem& problem, const LevelDesign& design);

/// Input disturbance; outputs y, u; loop: that of the feedback. `limit` empty: none.
Expected<StructureView> feedforward_view(const FeedforwardProblem& problem, const FeedforwardVariant& variant,
                                         std::optional<double> limit);

/// Inputs setpoint_1, load_1 and so on; outputs y_1, u_1 and so on; loops 1 and so on, and mu. `limit` empty: none.
Expected<StructureView> interaction_view(const std::string& of, const PlantMatrix& plants,
                                         const std::vector<IdealPid>& controllers, const Decoupling& decoupling,
                                         std::optional<double> limit);

/// Inputs setpoint, load; outputs y, u; one loop. Error: unsupported for an unstable model, whose responses grow by
/// rounding.
Expected<StructureView> predictor_view(const LinearPlant& plant, const PredictorController& controller,
                                       std::optional<double> limit);
/// The same of a PID.
Expected<StructureView> pid_view(const LinearPlant& plant, const IdealPid& controller);

}  // namespace tunewright::structure
