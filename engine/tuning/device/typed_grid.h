// The settings that can be entered near a design: numbers in the steps of their resolution.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/device/device_model.h"

namespace tunewright::device {

/// The number in a text; `fallback` if it is none.
double number_of(const std::string& text, double fallback);

/// `near` is a design within the limits before its settings were rounded. All combinations of rounding its numbers up
/// or down are tried, and for coarse steps the neighbours too. Error: no_feasible_controller if none keeps the limits
/// with a load IAE below `enough`.
Expected<Fitted> on_grid(const DeviceModel& device, const std::vector<const LinearPlant*>& plants,
                         const PeakLimits& limits, Fitted near, double enough, const RunControl& control);

}  // namespace tunewright::device
