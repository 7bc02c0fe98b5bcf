// How much a load that walks unseen may have changed a fit.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// The rows of a fit's least-squares problem, each a mean over neighbouring samples times the root of their number.
struct FittedRows {
    Eigen::VectorXd time;      ///< n: dimensionless
    Eigen::VectorXd weight;    ///< n: root of the number of samples
    Eigen::VectorXd residual;  ///< n
    Eigen::MatrixXd J;         ///< n x m: the columns fitted
};

/// X' R X for the covariance R of what the residual came from, X = `rows.J`: noise of y that is a first-order
/// autoregression, and a load at the plant's input that wanders as a random walk, which gain and time constants follow
/// so that little of it is left in the residual. One for each pair of coefficient and load that the residual does not
/// tell from the likeliest, the degrees of freedom that the fit took away left out of account (restricted maximum
/// likelihood: Patterson and Thompson 1971). None for fewer than some 30 rows.
std::vector<Eigen::MatrixXd> weighed_with_load(const Fit& fit, const FittedRows& rows);

}  // namespace tunewright
