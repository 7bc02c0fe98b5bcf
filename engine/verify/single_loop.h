// One plant with one controller as a block diagram: set point with weights and lag, load at the plant's input.
//
//   u = Kp (b r_f - y_f) + Ki int (r_f - y_f) + Kd d/dt (c r_f - y_f),   r_f = r/(1 + s T)
//
// y_f as the filter has it (controller/pid.h). Without a filter the derivative of y is the block Kd s P(s) from u to u.
#pragma once

#include "engine/blocks/block_diagram.h"
#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::verify {

struct SingleLoop {
    BlockDiagram diagram;
    int r = 0;                      ///< the set point enters here
    int u = 0;                      ///< a load enters here
    int y = 0;                      ///< the plant's output
    int seen = 0;                   ///< the controller's measurement: noise enters here
    bool has_hidden_poles = false;  ///< the derivative's block repeats the plant's poles
};

/// Errors: unsupported for a derivative without a filter of y on a plant that is unstable or without pole excess, or of
/// r without a lag.
Expected<SingleLoop> single_loop(const LinearPlant& plant, const ParallelPid& pid);

}  // namespace tunewright::verify
