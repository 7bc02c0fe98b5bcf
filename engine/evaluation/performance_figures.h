// Time-domain figures of simulated responses, and their traces for plots.
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

/// Integrals over a response.
struct Indices {
    std::optional<ErrorIntegrals> error;
    const char* why_no_error = nullptr;  ///< the reason if the error's integrals have no value
    double TV = 0;
};
/// `target`: final value of y. `to_infinity`: integrals run to infinity (the response settled), else to the last node.
Indices indices_of(const StepResponse& response, double target, bool to_infinity);

/// `indices`: the response's own, if they are already known.
SetpointPerformance setpoint_figures(const StepResponse& response, double step, bool to_infinity,
                                     const std::optional<Indices>& indices = {});
LoadPerformance load_figures(const StepResponse& response, bool to_infinity,
                             const std::optional<Indices>& indices = {});

/// The loop must be stable; `noise.sample_time` 0 stands for the default of the loop (loop/noise.h).
NoisePerformance noise_figures(const Loop& loop, const NoiseOptions& noise);

/// The reason why the integrals of target - y have no value; null if they have one.
const char* why_no_integral(const StepResponse& response, double target, bool to_infinity);

/// A performance with every figure empty, for one reason.
Performance no_performance(const std::string& reason);

/// The next number at or above a value > 0 that has two significant digits; 0 for other values.
double two_digits_up(double value);

/// Long enough for both responses to stay within 1 % of their largest deviation, and a little more; two significant
/// digits.
double covering_horizon(const StepResponse& setpoint, const StepResponse& load);

/// `points` equidistant values from 0 to `horizon`.
Trace trace_of(const StepResponse& response, double horizon, int points);

}  // namespace tunewright
