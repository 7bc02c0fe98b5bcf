// Both responses of a controller as they were simulated, kept until it is known over which time an answer shows them.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// One response, and how far it is known: beyond the last node only where it has come to rest.
struct KnownResponse {
    StepResponse response;
    double known_to = std::numeric_limits<double>::infinity();
    static KnownResponse of(StepResponse response);
};

struct ResponsePair {
    KnownResponse setpoint, load;
    double horizon = 0;  ///< what the responses ask for; covering_horizon of performance_figures.h
    int points = 0;      ///< of each trace, >= 2
    bool settles = true;
};

/// Traces with `options.points` values: up to the horizon that `options` give, or up to their own, which may still
/// change. Empty without points.
std::optional<Responses> drawn(KnownResponse setpoint, KnownResponse load, const EvaluateOptions& options);

/// The traces up to `horizon`, each as far as it is known. The course stays with them until draw_together.
Responses responses_of(std::shared_ptr<const ResponsePair> course, double horizon);

/// Draws all that have a course up to one horizon, so that they can be compared by eye, and lets their courses go: the
/// longest that one of them asks for, but not beyond three times the shortest, where the quick ones would be a line at
/// the left edge. What does not settle has no say.
void draw_together(const std::vector<Responses*>& all);

}  // namespace tunewright
