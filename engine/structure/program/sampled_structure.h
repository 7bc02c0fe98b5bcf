// A structure's program on its plants, call by call: plants and dead times exact between the calls, the limits, rate
// limits and anti-windup of the program active.
//
//   y_i = sum_j P_ij v_j,   v_j = the program's output that is held there since the last call, and a load
//
// At each place S(e^(j omega Ts)) is the transform of the signal's response to a unit pulse that enters there, in the
// loop without limits; Ms is its maximum up to pi/Ts. As Ts falls the figures become those of the continuous structure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/code/program.h"
#include "engine/figure.h"
#include "engine/progress.h"
#include "engine/structure/cascade.h"
#include "engine/structure/interaction_gains.h"
#include "engine/structure/level.h"
#include "engine/structure/step_figures.h"

namespace tunewright::structure {

/// What enters in one run, in deviations from the operating point.
struct SampledStep {
    std::string name;
    std::map<std::string, double> inputs = {};  ///< of the program
    std::map<std::size_t, double> loads = {};   ///< at held inputs
    std::vector<double> targets = {};           ///< what each y should become; shorter: 0
};

/// A place where a loop is broken, and the program's inputs for it, such as a mode.
struct SampledPlace {
    std::string name;
    bool at_plant_input = false;  ///< else at a measurement
    std::size_t signal = 0;
    std::map<std::string, double> inputs = {};
};

/// The plants around a program, and what it is asked.
struct SampledScene {
    PlantMatrix plants;                       ///< [i][j]: from held input j to y_i
    std::vector<std::string> measurements;    ///< the program's input for each y
    std::vector<std::string> outputs;         ///< its output at each held input; the inputs beyond have loads alone
    std::map<std::string, std::string> rest;  ///< of a signal: the program's setting with its operating point
    std::vector<SampledStep> steps;
    std::vector<SampledPlace> places;
    std::size_t controlled = 1;  ///< figures are of so many y
};

struct SampledResponse {
    std::string name;
    std::vector<StepFigures> figures;    ///< of each controlled y, until everything rests; TV is that of its u
    double largest_rate = 0;             ///< of the first u from call to call
    std::vector<std::vector<double>> y;  ///< of each y at the calls, deviations; one every Ts from t = 0
    std::vector<std::vector<double>> u;  ///< of each output of the program, in its order; held until the next call
};

struct SampledAnswer {
    std::map<std::string, Figure> Ms;  ///< at each place
    std::vector<SampledResponse> responses;
};

/// `sizes`: of steps by their names, 1 for the others; once a limit is reached responses are not proportional to them.
/// The program's setting Ts is the sample time; its times are in the unit of the plants'. Error: refuse_sampling().
Expected<SampledAnswer> run_sampled(const code::Program& program, const SampledScene& scene,
                                    const std::map<std::string, double>& sizes, const RunControl& control);

/// The scenes of the structures. Their names are those of the figures without sampling: inner_load, outer_load,
/// setpoint; load, setpoint; disturbance; load_1, setpoint_1. Places: inner, outer, valve; loop; loop_1. Error: a
/// product of plants that has too many states.
Expected<SampledScene> cascade_scene(const CascadePlants& plants);
SampledScene loop_scene(const LinearPlant& plant);  ///< of a predictor, and of a single controller
SampledScene feedforward_scene(const LinearPlant& plant, const LinearPlant& disturbance);
/// `load`: of the inflow. The controller's output is the outflow, behind the flow loop.
SampledScene level_scene(double area, const FlowLoop& flow);
SampledScene interaction_scene(const PlantMatrix& plants);

}  // namespace tunewright::structure
