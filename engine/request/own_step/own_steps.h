// Simulates the user's own step with the controller of each entry.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/evaluation/own_step.h"
#include "engine/plant/analysed_plant.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright {

/// Fills `own_step` of every entry that has an evaluation, if there is a step.
///
/// 1. The loop of an entry is the one that runs: the user's own controller with its sample time, rounding and
///    anti-windup where the entry has one, else the continuous controller with back-calculation.
/// 2. Without a given `hold` each loop is run without the load; the hold that the slowest of them needs to come within
///    1 % of its rest, and a quarter more, is that of all, but at most three times the shortest.
/// 3. Each loop is run with the load, and its figures are taken. All traces end together, by the same rule.
///
/// A loop that rounding keeps moving is run for as long as it would need without. False: `control` asked to stop, and
/// no entry has a step.
///
/// `points`: of each trace, 0: none. `device_of`: the user's controller of an entry; null where it has none.
bool simulate_own_steps(std::vector<TuningEntry>& entries, const AnalysedPlant& subject,
                        const std::optional<OwnStep>& step, int points,
                        const std::function<const device::DeviceModel*(const TuningEntry&)>& device_of,
                        const RunControl& control);

}  // namespace tunewright
