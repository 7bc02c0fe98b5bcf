// Both simulated responses of a controller, kept until the time range of the answer's plots is known.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// One response and the range in which it is known: beyond the last node only if it has come to rest.
struct KnownResponse {
    StepResponse response;
    double known_to = std::numeric_limits<double>::infinity();
    static KnownResponse of(StepResponse response);
};

struct ResponsePair {
    KnownResponse setpoint, load;
    double horizon = 0;  ///< the horizon that the responses need; covering_horizon of performance_figures.h
    int points = 0;      ///< points of each trace, >= 2
    bool settles = true;
};

/// Traces with `options.points` values, up to the horizon of `options` or else up to their own, which may still change.
/// Empty without points.
std::optional<Responses> drawn(KnownResponse setpoint, KnownResponse load, const EvaluateOptions& options);

/// The traces up to `horizon`, each as far as it is known. They keep their responses until draw_together.
Responses responses_of(std::shared_ptr<const ResponsePair> course, double horizon);

/// Draws all that still have their responses up to one horizon, for comparison by eye, and then releases the responses.
/// The horizon is the longest that one of them needs, but at most three times the shortest, because quick responses
/// would be a line at the left edge. A response that does not settle is not considered.
void draw_together(const std::vector<Responses*>& all);

}  // namespace tunewright
