// An entry's controller converted to the user's own: the settings to enter, and the loop that they give.
#pragma once

#include <optional>
#include <vector>

#include "engine/evaluation/evaluate_sampled.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"
#include "engine/progress.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright {

enum class DifferingFigure { Ms, load_IAE, overshoot };

/// `Ms_percent`, `load_IAE_percent`: the relative increase of the implemented loop over the entry's ideal one.
struct DeviceEntry {
    device::Fitted fitted;
    DeviceLoop loop;
    Figure Ms_percent, load_IAE_percent;
    Figure overshoot_points;  ///< the difference in the set-point step's overshoot, in percent of the step
    std::vector<DifferingFigure> differs = {};  ///< figures whose difference is large enough to be reported
};

/// For known settings. `ideal`: the evaluation of the entry's controller. Errors: those of evaluating.
Expected<DeviceEntry> judge_device(const AnalysedPlant& subject, const device::DeviceModel& device,
                                   device::Fitted fitted, const EvaluateOptions& options, const Evaluation& ideal);

/// Converts the entry's controller and evaluates it. If the product cannot represent the controller, the settings are
/// those with the least load IAE that are at least as robust as the ideal loop (a note says so). Errors:
/// not_representable if there are none, unsupported for a nonlinear integral; those of evaluating.
Expected<DeviceEntry> device_entry_of(const AnalysedPlant& subject, const device::DeviceModel& device,
                                      const EvaluateOptions& options, const Evaluation& ideal,
                                      const RunControl& control);

/// Adds the device entry to the evaluation, with a warning if the implemented loop differs: unstable, or Ms or the load
/// IAE changed by more than 2 %. An error of the conversion becomes a warning too: the ideal loop stays in the answer.
void take_device_entry(Expected<DeviceEntry> on_device, Evaluation& evaluation, std::optional<DeviceEntry>& entry);

}  // namespace tunewright
