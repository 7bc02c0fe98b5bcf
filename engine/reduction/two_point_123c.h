// Alfaro's two-point reduction 123c: a first-order model through 25 % and 75 % of the exact step response.
#pragma once

#include "engine/reduction/reduction.h"

namespace tunewright {

/// T = 0.9103 (t75 - t25), L = 1.2620 t25 - 0.2620 t75 with the times, dead time included, at which the response first
/// reaches 25 % and 75 % of its static change; K static. The constants are the published, rounded ones (1/ln 3 and so
/// on): published models are reproduced to their digits, and rules were fitted on such models.
///
/// Integrating plants: first order, the ramp's asymptote; second order, the two points on the response's slope, which
/// goes from 0 to K with the lag T.
///
/// Errors (the message is the bare reason, which reduce() puts into its sentence): unsupported, `where`
/// "reduction/method", where the construction gives T <= 0 or L < 0. Source: Alfaro, Ciencia y Tecnologia 24 (2006)
/// 197-216.
Expected<ReducedModel> two_point_123c(const LinearPlant& plant, ReducedOrder order);

}  // namespace tunewright
