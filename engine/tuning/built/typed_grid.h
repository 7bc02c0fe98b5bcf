// The settings that can be typed around a design: numbers in the steps of their resolution.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/built/build.h"

namespace tunewright::built {

/// The number that a text says; `otherwise` where it is none.
double number_of(const std::string& text, double otherwise);

/// `near` is a design within the limits before its settings were rounded. All ways to round its numbers up or down are
/// tried, and where a step is coarse the neighbours too. Error: no_feasible_controller where none holds the limits and
/// has a load IAE below `enough`.
Expected<Fitted> on_grid(const Build& build, const std::vector<const LinearPlant*>& plants, const Limits& limits,
                         Fitted near, double enough, const RunControl& control);

}  // namespace tunewright::built
