// What an entry's controller becomes on the user's own: the settings to type, and the loop as it then computes.
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

/// `Ms_percent`, `load_IAE_percent`: by how much the loop as built lies above the entry's ideal one.
struct DeviceEntry {
    device::Fitted fitted;
    DeviceLoop loop;
    Figure Ms_percent, load_IAE_percent;
    Figure overshoot_points;                    ///< the same of the set-point step's overshoot, in percent of the step
    std::vector<DifferingFigure> differs = {};  ///< those that lie so far off that it is said
};

/// Of settings that are known. `ideal`: the evaluation of the entry's controller. Errors: those of evaluating.
Expected<DeviceEntry> judge_device(const AnalysedPlant& subject, const device::DeviceModel& device,
                                   device::Fitted fitted, const EvaluateOptions& options, const Evaluation& ideal);

/// Converts the entry's controller and judges it. What the product cannot be is met by the settings with the least load
/// IAE that are at least as robust as the ideal loop (a note says so). Errors: not_representable where there are none,
/// unsupported for a nonlinear integral; those of evaluating.
Expected<DeviceEntry> device_entry_of(const AnalysedPlant& subject, const device::DeviceModel& device,
                                      const EvaluateOptions& options, const Evaluation& ideal,
                                      const RunControl& control);

/// Puts it beside the evaluation, with a warning where the loop as built is another one: unstable, or Ms or the load
/// IAE moved by more than 2 %. What keeps a controller from being built is a warning too: the ideal loop is answered
/// all the same.
void take_device_entry(Expected<DeviceEntry> on_device, Evaluation& evaluation, std::optional<DeviceEntry>& beside);

}  // namespace tunewright
