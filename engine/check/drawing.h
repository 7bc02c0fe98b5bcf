// The parts of a check that are drawn: the record's trend, its last periods, spectrum and autocorrelation.
#pragma once

#include "engine/check/loop_check.h"
#include "engine/check/oscillation/oscillation.h"
#include "engine/check/samples.h"

namespace tunewright::check {

/// The extremes of measurement and output in even stretches of the whole record.
Trend trend_of(const Samples& samples);

/// Sets excerpt, spectrum and autocorrelation.
void draw_details(const Samples& samples, const OscillationStudy& study, LoopCheck& check);

}  // namespace tunewright::check
