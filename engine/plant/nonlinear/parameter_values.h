// Parameters of a nonlinear plant as numbers: those given as expressions are worked out from the others.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright {

struct ParameterValues {
    std::map<std::string, double> values;  ///< all finite
    int nodes = 0;                         ///< numbers, names and operations of the expressions among them
};

/// In any order. Errors with `where` = "plant/parameters/k": a text that is no expression, a name that is no parameter,
/// a circle (which the message names), a value that is not finite.
Expected<ParameterValues> parameter_values(const std::vector<Parameter>& parameters);

}  // namespace tunewright
