// A response computed with steps so short that its indices have the stated accuracy, and their errors.
//
// A run is repeated with every step halved until no index changes by more than its largest error. The interpolation
// within a step and the indices' quadrature are both of order 4, so the finer run's own error is about a fifteenth of
// the change: the change bounds the error wherever halving the steps at least halves it. The tail beyond a run's end
// adds at most 1e-6, and no smaller error is claimed. The tests check both for 105 loops of all kinds.
#pragma once

#include <functional>
#include <optional>

#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Largest relative errors of the indices of a measured response.
inline constexpr double kMaxIaeError = 1e-5, kMaxIseError = 1e-5, kMaxItaeError = 2e-5, kMaxTvError = 5e-5;

struct MeasuredResponse {
    StepResponse response;
    IndexErrors errors;              ///< of the indices that exist
    std::optional<Indices> indices;  ///< of a response that settles
};

using Simulate = std::function<StepResponse(const ResponseOptions&)>;

/// `simulate` is run with `options` and then finer: on the halved schedule where it gives one, else with a sixteenth of
/// the tolerance (which halves steps of order 4) or less. `target`: final value of y. Without a horizon the integrals
/// go to infinity.
MeasuredResponse measure(const Simulate& simulate, ResponseOptions options, double target);

/// True if every error is known and at most the largest allowed; also true for a response that does not settle, because
/// no accuracy is stated for its indices.
bool is_accurate(const MeasuredResponse& measured);

}  // namespace tunewright
