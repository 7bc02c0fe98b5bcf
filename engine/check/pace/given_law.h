// Today's settings as given, or as the record shows them.
#pragma once

#include <optional>

#include "engine/check/output_range.h"
#include "engine/check/samples.h"

namespace tunewright::check {

struct ChosenLaw {
    LoopLaw law;
    std::optional<Warning> differs;  ///< controller-differs: the record shows another law than the given one
};

/// Gain and Ti of the given controller; those of loop_law() if none is given, if it has no gain, or if the record
/// clearly shows another gain or Ti. Not compared: a given controller with derivative action, which the fit has not,
/// and a record with the output at a limit, where no law holds.
ChosenLaw chosen_law(const LoopQuestion& question, const Samples& samples, const OutputRange& u_range,
                     const UnitNames& units);

}  // namespace tunewright::check
