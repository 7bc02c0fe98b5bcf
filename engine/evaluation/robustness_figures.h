// Frequency-domain figures of an evaluation: peaks and margins, the same over a family of plants, and the loop's
// curves.

#pragma once

#include <vector>

#include "engine/controller/sampled/sampled_pid.h"
#include "engine/evaluation/evaluation.h"
#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// Robustness of a stable loop, computed from the peaks and margins on its own grid.
Robustness robustness_of(const AnyLoop& loop, const LoopGrid& grid);

/// For an unstable loop: every figure is empty and has the reason.
Robustness unstable_robustness(const StabilityCount& count);

/// Figures of one controller over all plants of a family. `stable_fraction`: of each region by 128 points spread
/// uniformly over its parameters, and the mean over the plants of a set; 1 only if no unstable plant was found.
/// `worst_Ms`: the largest at those points, at the regions' centres and ends and at the result of a local search from
/// the worst of them.
RegionFigures region_figures(const PlantFamily& family, const ParallelPid& controller);
/// The same for a program that computes once every sample time.
RegionFigures region_figures(const PlantFamily& family, const SampledPid& law);

/// The loop's curves for drawing: at most `points` frequencies, spread so that neighbours differ as little as possible
/// in the phase of L, in |L| and in omega; a dead time's turns are followed until |L| is too small to be visible.
/// `kept`, frequencies of peaks and crossovers, are among them. The phase is unwrapped, the dead time's turns counted.
FrequencyTraces frequency_traces(const Loop& loop, const LoopGrid& grid, int points,
                                 const std::vector<double>& kept = {});

/// Every n-th point of the whole grid of a measured plant.
FrequencyTraces frequency_traces(const LoopGrid& whole, int points);

}  // namespace tunewright
