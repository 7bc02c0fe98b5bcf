// Whether a record begins at rest.
#pragma once

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// What the rows before the first move of u say of the start.
enum class Start {
    at_rest,  ///< y rests there, u0 is given, or u moves only once and nothing else is seen
    unseen,   ///< too few rows to tell in a record in which u moves more than once, or a relay at work from the first
              ///< row
    moving,   ///< y moves there
};

/// y moves where its slope over the rows before the first change of u exceeds five of its standard errors, and either
/// takes it by 3 % of its range and four times what scatters about the line, or exceeds five errors with the
/// correlation of that scatter counted and would take it by 5 % until the end of the record.
/// In a relay test that is at work from the first row on, y may rest there for a dead time: it is at rest only where it
/// stays within its noise until u first switches. `noise` is y's standard deviation from sample to sample.
Start start_of(const CleanRecord& record, bool relay, double noise);

}  // namespace tunewright
