// Level crossings and monotonicity of an exact step response, and where the ramp of an integrating plant starts.
#pragma once

#include <functional>
#include <vector>

#include "engine/reduction/reduction.h"
#include "engine/simulation/linear/step_response.h"

namespace tunewright {

/// Zero of f(sample) between two samples at which it has opposite signs, on the exact response.
StepSample crossing(const Realisation& realisation, const StepSample& from, const StepSample& to,
                    const std::function<double(const StepSample&)>& f);

/// When y first reaches `level` (the dead time left out), coming from the side of 0; the last sample's time if never.
double time_at(const LinearPlant& plant, const std::vector<StepSample>& samples, double level);

/// A warning "not-monotone" where |static gain| over the response's total variation is below 0.8 (Astrom & Hagglund
/// 2006, Section 2.6).
std::vector<Warning> monotonicity_warnings(const std::vector<StepSample>& samples, double static_gain);

/// Where the asymptote of an integrating plant's ramp starts: the dead time plus lags minus leads.
double ramp_delay(const LinearPlant& plant);

/// K/s e^(-Ls) whose ramp is the asymptote of an integrating plant's: L is the dead time plus lags minus leads,
/// exactly. Errors: unsupported where that is negative.
Expected<ReducedModel> ramp_asymptote(const LinearPlant& plant);

/// The bare reason why a method does not apply, which reduce() puts into its sentence.
Error reduction_fails(const std::string& reason);

}  // namespace tunewright
