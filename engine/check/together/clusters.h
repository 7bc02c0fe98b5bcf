// Loops that belong together: they oscillate as one, or the output of one is the set point of another.
#pragma once

#include <span>
#include <vector>

#include "engine/check/together/plant_check.h"

namespace tunewright::check {

/// Loops whose main periods agree and, where their records share a time, whose waves keep one phase. The largest first.
std::vector<Cluster> clusters_of(std::span<const LoopCheck* const> loops);

std::vector<CascadePair> cascades_of(std::span<const LoopCheck* const> loops);

}  // namespace tunewright::check
