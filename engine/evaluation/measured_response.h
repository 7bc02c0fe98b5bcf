// A response on steps so short that the indices taken from it are as exact as promised, and how exact they are.
//
// A run is repeated with every step halved until no index moves by more than is promised of it. The interpolation
// within a step and the indices' quadrature are both of order 4, so the finer run's own error is about a fifteenth of
// the move: the move bounds it wherever halving the steps halves the error at least. What the tail beyond a run's end
// may hold comes to 1e-6 at most, below which nothing is claimed. The tests hold 105 loops of all kinds to both.
#pragma once

#include <functional>
#include <optional>

#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Relative errors that the indices of a measured response keep.
inline constexpr double kPromisedIae = 1e-5, kPromisedIse = 1e-5, kPromisedItae = 2e-5, kPromisedTv = 5e-5;

struct MeasuredResponse {
    StepResponse response;
    IndexErrors errors;              ///< of the indices that exist
    std::optional<Indices> indices;  ///< of a response that settles
};

using Simulate = std::function<StepResponse(const ResponseOptions&)>;

/// `simulate` is run with `options` and then finer: on the halved schedule where it gives one, else with a sixteenth of
/// the tolerance (which halves steps of order 4) or less. `target` is what y is to reach. Without a horizon the
/// integrals go to infinity.
MeasuredResponse measure(const Simulate& simulate, ResponseOptions options, double target);

/// Whether every error is known and within its promise; true of a response that does not settle, which promises none.
bool as_promised(const MeasuredResponse& measured);

}  // namespace tunewright
