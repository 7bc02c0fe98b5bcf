// A nonlinear plant's texts checked and compiled: everything that can be said about them without evaluating the
// equations.
#pragma once

#include "engine/expected.h"
#include "engine/plant/expression/program.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright {

struct PlantProgram {
    Program joint;   ///< outputs 0 to n - 1: d/dt of the states; output n: y. Variables: the states, then the input
    Program output;  ///< y alone, of the same variables
};

/// At most 20 states, 200 parameters, 5000 numbers, names and operations. Errors: see NonlinearSystem::make.
Expected<PlantProgram> compile_plant(const NonlinearPlant& plant);

}  // namespace tunewright
