// Estimates a model from a loop's record by instrumental variables instead of least squares.
#pragma once

#include <optional>
#include <stop_token>

#include "engine/identification/closed_loop/set_point_part.h"
#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// A fit whose whitened residual is orthogonal to the sensitivities for only the set point's part of u: Z'e = 0 with Z
/// from `driven_by`, instead of J'e = 0, where J also contains the reactions of u to disturbances. It is consistent
/// under feedback for disturbances of any spectrum (refined instrumental variables: Young and Jakeman 1979; in closed
/// loop: Gilson and Van den Hof 2005). Residual and instruments are filtered by an autoregressive model of the
/// residual.
struct InstrumentFit {
    Fit fit;                ///< `deviations` filled: s^2 (Z'J)^-1 Z'Z (J'Z)^-1 by its principal axes
    double mismatch = 0;    ///< share of the filtered residual's variance that filters of the set point explain, times
                            ///< the independent samples: about the number of filters, 10, for the correct structure
    double gain_error = 0;  ///< standard error of the gain over its size
};

/// Iterates from the form, shape and coefficients of `start`; `part` belongs to the record's samples. Empty if the
/// equations are singular, if the result is not finite, or if `stop` is set before there is a model.
std::optional<InstrumentFit> fit_by_instrument(const CleanRecord& record, const SetPointPart& part, const Fit& start,
                                               const std::stop_token& stop);

}  // namespace tunewright
