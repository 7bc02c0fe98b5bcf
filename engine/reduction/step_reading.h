// Quantities of an exact step response: level crossings, monotonicity, the start of an integrating plant's ramp; and
// the two reductions that need only these.
#pragma once

#include <functional>
#include <vector>

#include "engine/reduction/reduction.h"
#include "engine/simulation/linear/step_response.h"

namespace tunewright {

/// Zero of f(sample) between two samples at which it has opposite signs, on the exact response.
StepSample crossing(const Realisation& realisation, const StepSample& from, const StepSample& to,
                    const std::function<double(const StepSample&)>& f);

/// The time at which y first reaches `level` (without the dead time), coming from the side of 0; the last sample's time
/// if never.
double time_at(const LinearPlant& plant, const std::vector<StepSample>& samples, double level);

/// A warning "not-monotone" if |static gain| over the response's total variation is below 0.8 (Åström & Hägglund 2006,
/// Section 2.6).
std::vector<Warning> monotonicity_warnings(const std::vector<StepSample>& samples, double static_gain);

/// The start of the asymptote of an integrating plant's ramp: the dead time plus lags minus leads.
double ramp_delay(const LinearPlant& plant);

/// K/s e^(-Ls) whose ramp is the asymptote of an integrating plant's: L is the dead time plus lags minus leads,
/// exactly. Errors: unsupported if that is negative.
Expected<ReducedModel> ramp_asymptote(const LinearPlant& plant);

/// The reason why a method does not apply, which reduce() puts into its sentence.
Error reduction_fails(const std::string& reason);

/// The tangent at the steepest point of the response, as drawn since Ziegler and Nichols (1942). See reduction.h;
/// integrating plants: the ramp's asymptote, exactly. Errors (the message is only the reason, which reduce() puts into
/// its sentence): unsupported, `where` "reduction/method", if the response jumps, if a lead leaves no dead time, or if
/// no tangent model with T > 0 exists.
Expected<ReducedModel> tangent(const LinearPlant& plant, TangentTime time);

/// Alfaro's reduction 123c, a first-order model through two points of the response:
/// T = 0.9103 (t75 - t25), L = 1.2620 t25 - 0.2620 t75 with the times, dead time included, at which the response first
/// reaches 25 % and 75 % of its static change; K static. The constants are the published, rounded ones (1/ln 3 and so
/// on): published models are reproduced to their digits, and rules were fitted on such models.
///
/// Integrating plants: first order, the ramp's asymptote; second order, the two points of the response's slope, which
/// rises from 0 to K with the lag T.
///
/// Errors (the message is only the reason, which reduce() puts into its sentence): unsupported, `where`
/// "reduction/method", if the construction gives T <= 0 or L < 0. Source: Alfaro, Ciencia y Tecnologia 24 (2006)
/// 197-216.
Expected<ReducedModel> two_point_123c(const LinearPlant& plant, ReducedOrder order);

}  // namespace tunewright
