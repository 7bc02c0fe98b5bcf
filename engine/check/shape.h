// What the judgement of many loops needs of one: its spectrum and its wave on a common clock.
#pragma once

#include "engine/check/loop_check.h"
#include "engine/check/oscillation/oscillation.h"
#include "engine/check/samples.h"

namespace tunewright::check {

Shape shape_of(const Samples& samples, const Oscillation& oscillation, const OscillationStudy& study,
               const LoopQuestion& question);

}  // namespace tunewright::check
