// A linear plant as text for control software.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/plant/plant.h"

namespace tunewright {

struct PlantSnippet {
    std::string_view name;  ///< of the software
    std::string text;       ///< lines without a line break at the end; the plant is P, in Modelica the block `process`
};

/// The plant for MATLAB, python-control, ControlSystems.jl and Modelica, with all digits: read_plant reads
/// each text as this plant, except for python-control with a dead time. python-control has none, so its text has a Pade
/// approximation of order kPadeOrder. Uncertainty is omitted. `time_unit`: the label of the unit of the plant's times;
/// a first line names it if it is not s.
std::vector<PlantSnippet> plant_snippets(const Plant& plant, std::string_view time_unit);

inline constexpr int kPadeOrder = 5;

}  // namespace tunewright
