// Checks and compiles a nonlinear plant's texts: all checks that do not need an evaluation of the equations.
#pragma once

#include "engine/expected.h"
#include "engine/plant/expression/program.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright {

/// `joint` for rates and derivatives, `output` for the output alone, which is faster.
struct PlantProgram {
    Program joint;   ///< outputs 0 to n - 1: d/dt of the states; output n: y. Variables: the states, then the input
    Program output;  ///< y alone, with the same variables
};

/// At most 20 states, 200 parameters, and 5000 numbers, names and operations in all texts together. Parameters given as
/// expressions are computed first, in any order. The cost is linear in the lengths of the texts.
///
/// Errors: the first one found, invalid_argument with `where` =
///   "plant/states/T", "plant/parameters/k", "plant/input", "plant/input/nominal", "plant/input/min", "plant/L": a name
///       that is not valid or already used, a number that is not finite, an empty range of the input, no or too many
///       states;
///   "plant/parameters/k": a text that is not an expression, a name that is not a parameter, a circle (which the
///       message names), a value that is not finite;
///   "plant/equations", "plant/equations/T": a state without an equation or with two, an equation without a state, a
///       text that is not an expression (with its place), an unknown name;
///   "plant/output": the same of the output; an output that contains the input, or no state.
/// NonlinearSystem::make checks whether the equations can be evaluated at the states.
Expected<PlantProgram> compile_plant(const NonlinearPlant& plant);

}  // namespace tunewright
