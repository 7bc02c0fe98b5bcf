// The time-domain figures of the contract from simulated responses, and the traces that show them.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/loop/loop.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// `to_infinity`: integrals run to infinity (the response settled), else to the last node.
SetpointPerformance setpoint_figures(const StepResponse& response, double step, bool to_infinity);
LoadPerformance load_figures(const StepResponse& response, bool to_infinity);

/// The loop must be stable; `noise.sample_time` 0 takes the loop's own (loop/noise.h).
NoisePerformance noise_figures(const Loop& loop, const NoiseOptions& noise);

/// Why the integrals of target - y have no value; null where they have one.
const char* why_no_integral(const StepResponse& response, double target, bool to_infinity);

/// Every figure empty, for one reason.
Performance no_performance(const std::string& reason);

/// Long enough for both responses to stay within 1 % of their largest deviation, and a little more; two significant
/// digits.
double covering_horizon(const StepResponse& setpoint, const StepResponse& load);

/// `points` equidistant values from 0 to `horizon`.
Trace trace_of(const StepResponse& response, double horizon, int points);

}  // namespace tunewright
