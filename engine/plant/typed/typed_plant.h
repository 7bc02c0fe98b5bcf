// Reads a linear plant from one line of typed text, and writes it as such.
//
//   read_plant("2 e^(-3s)/((10s+1)(2s+1))")        second order, K 2, T1 10, T2 2, L 3
//   read_plant("K=2 T=10 min L=30 s")              first order, T 600 and L 30
//   read_plant("zeros -1, poles -2 -3±4i, gain 5") zeros and poles
//   read_plant("tf([2],[10 1],'InputDelay',3)")    first order
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/expected.h"
#include "engine/plant/plant.h"
#include "engine/plant/typed/formula.h"

namespace tunewright {

struct TypedPlant {
    Plant plant;
    std::optional<typed::Formula> formula;  ///< in the factors in which it was written; empty for a state space
};

/// `seconds_per_time`: seconds of the plant's unit of time, into which units in the text are converted; 0 if that unit
/// is unknown, then a unit in the text is an error. Numbers without a unit are not converted.
///
/// A text is read by the grammar of parameter_parser.h, or as a formula or a program (program.h), perhaps with a name
/// before it such as "P(s) =".
/// Every spelling of one plant gives the same plant. Errors (invalid_argument): "position 7: <what, cure>"; a plant
/// that is improper, not causal or 0; numbers that plant_faults refuses; a text longer than typed::kMaxLength.
Expected<TypedPlant> read_plant(std::string_view text, double seconds_per_time = 1);

/// The shortest text that read_plant reads as this plant (or as an equal one of a simpler type). Empty for a state
/// space that would need more than typed::kMaxLength bytes. Uncertainty is omitted.
std::string plant_text(const Plant& plant);

}  // namespace tunewright
