// A model from a loop's record: instrumental variables in place of least squares.
#pragma once

#include <optional>
#include <stop_token>

#include "engine/identification/closed_loop/set_point_part.h"
#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// A fit whose residual, made white, is orthogonal to the sensitivities that the set point's part of u alone would
/// give: Z'e = 0 with Z from `driven_by`, in place of J'e = 0, where J holds what the disturbances made u do.
/// Consistent under feedback whatever colours the disturbances have (refined instrumental variables: Young and Jakeman
/// 1979; in closed loop: Gilson and Van den Hof 2005). Residual and instruments are filtered by an autoregressive model
/// of the residual.
struct InstrumentFit {
    Fit fit;                ///< `deviations` filled: s^2 (Z'J)^-1 Z'Z (J'Z)^-1 by its principal axes
    double mismatch = 0;    ///< share of the filtered residual's variance that filters of the set point explain, times
                            ///< the independent samples: about the number of filters, 10, where the structure
                            ///< is right
    double gain_error = 0;  ///< standard error of the gain over its size
};

/// Iterates from `start`'s form, shape and coefficients; `part` is of the record's samples. Empty where the equations
/// are singular or the result is not finite, and where `stop` asks for an end before there is a model.
std::optional<InstrumentFit> fit_by_instrument(const CleanRecord& record, const SetPointPart& part, const Fit& start,
                                               const std::stop_token& stop);

}  // namespace tunewright
