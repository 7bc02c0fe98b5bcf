// The same steps under a few controllers that differ a little from that of a run, as a gradient asks for: on the run's
// own instants and all at once, one in each number of a register.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "engine/numerics/registers.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

constexpr std::size_t kMaxNeighbours = 4;

/// IAE under each of the controllers (at most kMaxNeighbours, of the run's own form: as many states), closed by the
/// exact integral of the error as `integral_of_absolute_error` does. The error is taken to change its sign where that
/// of the run does, moved as far as its slope says there. Each loop must be stable. Empty: the run has a horizon, steps
/// too long for a map (run_setup.h), or no integral action; then each is a run of its own.
std::optional<std::array<double, kMaxNeighbours>> neighbouring_iaes(const LinearPlant& plant,
                                                                    std::span<const ParallelPid> controllers,
                                                                    const StepInputs& inputs, const StepResponse& run,
                                                                    Registers registers = widest_registers());

}  // namespace tunewright
