// Records that begin when a controller is switched on: the previous value of u is not recorded.
#pragma once

#include "engine/expected.h"
#include "engine/identification/identify.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// The level of u that means "off": 0, or the lower end of `u_limits` if that is above 0.
double off_level(const Record& record);

enum class ColdStart { none, possible, plain };

/// Decides whether u left its level of rest at the first row or before, while y is at rest there and then moves by half
/// of its range or more, from one end of it.
/// - Plain: u is constant in the first rows and y leaves its rest before u moves; or u moves from the first rows on, in
///   a loop (`in_loop`).
/// - Possible: u, in a loop or perhaps moved by a controller, changes only by small moves without a step until y leaves
///   its rest.
/// - None: u0 is given, u begins at its off level or takes values on both sides of it, or the set point moves.
ColdStart cold_start(const Record& record, const CleanRecord& clean, bool in_loop);

/// Chooses the model for such a record. `estimated`: the model with u0 estimated, or equal to the first row's u;
/// `from_off`: the model with u at its off level before the first row.
///
/// 1. If the record determines u0 (the gain of `estimated` has a standard error below a tenth of it, and its residual
///    is not larger than the other's, which does not explain the record as well): `estimated`.
/// 2. If the residual of `from_off` is not larger: that, with the warning u0-not-recorded; another equally good model
///    becomes one of its alternatives, which a design considers.
/// 3. Else `estimated`; with that warning, of level bad, if the start is plain.
Expected<IdentifiedModel> cold_start_model(ColdStart start, Expected<IdentifiedModel> estimated,
                                           Expected<IdentifiedModel> from_off, double off);

}  // namespace tunewright
