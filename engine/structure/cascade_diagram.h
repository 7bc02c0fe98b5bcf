// The block diagram of a cascade (cascade.h).
#pragma once

#include "engine/blocks/block_diagram.h"
#include "engine/structure/cascade.h"

namespace tunewright::structure {

/// The diagram and its signals. What enters from outside: r1 at `r1`, d1 at `outer_input` (series), d2 at `valve`.
struct CascadeDiagram {
    BlockDiagram diagram;
    int y1 = 0, y2 = 0, outer_input = 0, r1 = 0, r2 = 0, valve = 0;
};

/// `outer` null: the outer controller is in manual, and the outer plant is left out; y1 then does not move. Errors:
/// those of add_pid(), at "inner/controller" or "outer/controller".
Expected<CascadeDiagram> cascade_diagram(const CascadePlants& plants, const IdealPid& inner, const IdealPid* outer);

/// The controller moves the valve itself, from y1: without an inner loop.
Expected<CascadeDiagram> single_diagram(const CascadePlants& plants, const IdealPid& controller);

}  // namespace tunewright::structure
