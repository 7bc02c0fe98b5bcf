// How good a record in operation is, before anything is concluded from it.
#pragma once

#include "engine/check/loop_check.h"
#include "engine/check/samples.h"

namespace tunewright::check {

/// `samples` are those of `rows`.
RecordQuality quality_of(const Rows& rows, const Samples& samples);

}  // namespace tunewright::check
