// Records that begin with a controller's being switched on: where u came from is not in them.
#pragma once

#include "engine/expected.h"
#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// The level of u that stands for "off": 0, or the low end of `u_limits` above it.
double off_level(const Record& record);

enum class ColdStart { none, possible, plain };

/// Tells whether u left its level of rest with the first row or before it, and y rests there and then goes far: by half
/// of its range and more, from one end of it. Plain where u stands still in the first rows, and y leaves its rest
/// before u has moved, or where u moves from the first rows on, as that of the loop `in_loop`. Possible where such a
/// loop's u, or one that may be a controller's, only creeps until y leaves its rest, by small moves and no step. None
/// where u0 is given, where u begins at its off level or runs to both sides of it, and where the set point moves.
ColdStart cold_start(const Record& record, const CleanRecord& clean, bool in_loop);

/// Chooses what to answer for such a record. `estimated`: the model with u0 estimated, or taken from the first row;
/// `from_off`: the model with u at its off level before the first row.
///
/// 1. Where the record shows u0 by itself (the gain of `estimated` has a standard error below a tenth of it, and its
///    model leaves no more than the other, which does not contradict it as well): `estimated`.
/// 2. Where `from_off` leaves no more of y: that, with the warning u0-not-recorded; a rival that leaves as little
///    becomes one of its alternatives, which a design counts with.
/// 3. Else `estimated`; with that warning, of level bad, where the start is plain.
Expected<IdentifiedModel> cold_start_model(ColdStart start, Expected<IdentifiedModel> estimated,
                                           Expected<IdentifiedModel> from_off, double off);

}  // namespace tunewright
