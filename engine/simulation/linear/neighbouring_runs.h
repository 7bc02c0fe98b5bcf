// Repeats a run's steps with a few controllers that differ slightly, to compute a gradient: at the run's own times and
// all at once, one controller in each number of a register.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "engine/numerics/registers.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

constexpr std::size_t kMaxNeighbours = 4;

/// IAE under each of the controllers (at most kMaxNeighbours, of the run's own form: as many states), with the tail
/// from the exact integral of the error, as in `integral_of_absolute_error`. The changes of the error's sign are those
/// of the run, corrected by the slope there. Each loop must be stable. Empty if the run has a horizon, steps too long
/// for a map (run_setup.h), or no integral action; then each controller needs its own run.
std::optional<std::array<double, kMaxNeighbours>> neighbouring_iaes(const LinearPlant& plant,
                                                                    std::span<const ParallelPid> controllers,
                                                                    const StepInputs& inputs, const StepResponse& run,
                                                                    Registers registers = widest_registers());

}  // namespace tunewright
