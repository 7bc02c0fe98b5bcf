// The time-domain figures from simulated responses, and the traces that show them.
#pragma once

#include <optional>

#include "engine/evaluation/evaluation.h"
#include "engine/loop/loop.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// A response counts as settled while it stays within this fraction of the set-point step, or of the peak of the load
/// response. Some sentences state it in percent: tests/house/defaults_test.py lists them.
inline constexpr double kSettlingBand = 0.02;

/// What is integrated over a response.
struct Indices {
    std::optional<ErrorIntegrals> error;
    const char* why_no_error = nullptr;  ///< where the error's integrals have no value
    double TV = 0;
};
/// `target` is what y is to reach. `to_infinity`: integrals run to infinity (the response settled), else to the last
/// node.
Indices indices_of(const StepResponse& response, double target, bool to_infinity);

/// `indices`: the response's own, where they are known already.
SetpointPerformance setpoint_figures(const StepResponse& response, double step, bool to_infinity,
                                     const std::optional<Indices>& indices = {});
LoadPerformance load_figures(const StepResponse& response, bool to_infinity,
                             const std::optional<Indices>& indices = {});

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
