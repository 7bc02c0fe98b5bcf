// Unknowns of the recorded input, such as the times of its moves, that are estimated in addition to a model's
// parameters.
#pragma once

#include <Eigen/Core>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// k unknowns of the input of a record with n samples.
struct InputUnknowns {
    Eigen::MatrixXd slopes;     ///< n x k: d model/d unknown
    Eigen::VectorXd deviation;  ///< k: of the prior knowledge, a normal distribution; infinite: nothing is known
    Eigen::VectorXd rest;       ///< k: mean of the prior knowledge minus the estimate
};

/// The rows of fit.J that are samples: n x its columns.
Eigen::MatrixXd sample_rows(const Fit& fit);

/// The unknowns of both.
InputUnknowns joined(const InputUnknowns& one, const InputUnknowns& other);

/// Removes from the columns of `fit.J` the part that the unknowns may explain, and fills `fit.nuisance`: the remaining
/// part determines the parameters. Rows for the prior knowledge follow those of J. Does nothing without unknowns, or
/// without J.
void take_out_unknowns(const InputUnknowns& unknowns, Fit& fit);

}  // namespace tunewright
