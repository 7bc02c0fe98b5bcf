// What the servo/regulation rules tell beside their controller.
#pragma once

#include <optional>
#include <string>

#include "engine/plant/plant.h"

namespace tunewright {

struct ArrietaReport {
    Fopdt model;                        ///< that the rule worked on
    std::string constants;              ///< where its constants come from: table and column, or equation
    std::optional<double> Ms_design;    ///< of Table 1's column or Eq. 9
    std::optional<double> degradation;  ///< a level of Table 2, which the table may miss
    bool profile = false;               ///< the curves over Ms and over the levels are asked for
};

}  // namespace tunewright
