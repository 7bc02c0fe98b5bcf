// The identification of a relay test by Liu and Gao's formulas alone (relay_fourier.h).
#pragma once

#include "engine/expected.h"
#include "engine/identification/identify.h"
#include "engine/identification/relay_test/relay_fourier.h"

namespace tunewright {

/// The shift of Eq. 9, dimensionless: options.shift, in 1/time of the record, or 1/Pu. Error: invalid_argument for one
/// that is not above 0.
Expected<double> shift_of(const IdentifyOptions& options, const CleanRecord& record, const RecordedCycle& cycle);

/// The model that the formulas give and options.model allows; of several, the one that reproduces the steady
/// oscillation best. An integrator must reproduce it twice as well as a lag, unless both reproduce it well.
///
/// Warnings:
/// - rest-assumed: the relay already works at the start of the record;
/// - static-gain-contradiction: the means of y and u contradict the phase at the oscillation;
/// - structure-mismatch: the model reproduces the oscillation poorly;
/// - drift: the mean of y drifts.
///
/// Errors:
/// - unsupported: a second order was requested;
/// - not_identifiable: the record has no steady oscillation, or no model fits it;
/// - those of shift_of().
///
/// Without standard errors. `record` must be whole, not averaged.
Expected<IdentifiedModel> by_relay_formulas(const CleanRecord& record, const IdentifyOptions& options);

}  // namespace tunewright
