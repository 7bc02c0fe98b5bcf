// The answer to a relay test by Liu and Gao's formulas alone (relay_fourier.h).
#pragma once

#include "engine/expected.h"
#include "engine/identification/identify.h"
#include "engine/identification/relay_test/relay_fourier.h"

namespace tunewright {

/// The shift of Eq. 9, dimensionless: options.shift, in 1/time of the record, or 1/Pu. Error: invalid_argument for one
/// that is not above 0.
Expected<double> shift_of(const IdentifyOptions& options, const CleanRecord& record, const RecordedCycle& cycle);

/// The model that the formulas give and options.model admits, of several the one that repeats the steady oscillation
/// best; an integrator must repeat it twice as well as a lag, or as well where both do.
///
/// Warnings:
/// - rest-assumed: the record starts under the relay;
/// - static-gain-contradiction: the means of y and u contradict the phase at the oscillation;
/// - structure-mismatch: the model repeats the oscillation badly;
/// - drift: the mean of y creeps.
///
/// Errors:
/// - unsupported: a second order was asked for;
/// - not_identifiable: the record has no steady oscillation, or no model meets it;
/// - those of shift_of().
///
/// No standard errors. `record` is whole, not averaged.
Expected<IdentifiedModel> by_relay_formulas(const CleanRecord& record, const IdentifyOptions& options);

}  // namespace tunewright
