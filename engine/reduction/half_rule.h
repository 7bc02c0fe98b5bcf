// Skogestad's half rule: reduction from poles and zeros alone.
//
//   half_rule(*LinearPlant::make(Zpk{.K = 1, .zeros = {}, .poles = {-1.0, -5.0}, .L = 0.5}), ReducedOrder::first);
//   // 0.2 e^(-0.6 s)/(1.1 s + 1): the lag 0.2 goes half to the lag 1, half to the dead time
#pragma once

#include "engine/reduction/reduction.h"

namespace tunewright {

/// Half of the largest neglected lag is added to the smallest kept lag and half to L; smaller ones are added to L
/// entirely, and so is T0 of a right-half-plane zero (1 - T0 s). With an integrator a neglected lag is added to L
/// entirely, because an infinite lag does not change by half of it.
///
/// Left-half-plane zeros are first cancelled against neighbouring lags (rules T1 to T3, which may change K); the
/// effective dead time that these rules refer to is found by iteration. A complex pole pair with zeta >= 0.5 counts as
/// two lags zeta T (same first moment), with a warning.
///
/// `exact` if there was no lead, no complex pair and no neglected lag. beyond_reduction() of reduction.cpp must have
/// accepted the plant, so it is stable or has no more integrators than the order allows.
///
/// Errors (the message is only the reason, which reduce() puts into its sentence): unsupported, `where`
/// "reduction/method", for complex zeros, poles with zeta < 0.5, a lead without a lag to cancel. Source: Skogestad, J.
/// Process Control 13 (2003) 291-309, Eqs. 10-11 and Section 2.2.
Expected<ReducedModel> half_rule(const LinearPlant& plant, ReducedOrder order);

}  // namespace tunewright
