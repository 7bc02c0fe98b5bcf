// The settings that can be typed around a design: numbers in the steps of their resolution.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/device/device_model.h"

namespace tunewright::device {

/// The number that a text says; `fallback` where it is none.
double number_of(const std::string& text, double fallback);

/// `near` is a design within the limits before its settings were rounded. All ways to round its numbers up or down are
/// tried, and where a step is coarse the neighbours too. Error: no_feasible_controller where none holds the limits and
/// has a load IAE below `enough`.
Expected<Fitted> on_grid(const DeviceModel& device, const std::vector<const LinearPlant*>& plants,
                         const PeakLimits& limits, Fitted near, double enough, const RunControl& control);

}  // namespace tunewright::device
