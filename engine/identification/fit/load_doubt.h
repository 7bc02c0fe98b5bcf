// How much a load that walks unseen may have changed a fit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// The rows of a fit's least-squares problem, each a mean over neighbouring samples times the root of their number, so
/// that white noise keeps its variance. n rows, m columns.
struct FittedRows {
    Eigen::VectorXd time;      ///< n: dimensionless
    Eigen::VectorXd weight;    ///< n: root of the number of samples
    Eigen::VectorXd residual;  ///< n
    Eigen::MatrixXd J;         ///< n x m: the columns fitted
    /// Parameters fitted as well and taken out of J: their columns, n x k, and k rows of what is known of them, which
    /// have `known_J` in J's columns, `known_weight` on the diagonal and leave `known_rest`.
    Eigen::MatrixXd nuisance, known_J;
    Eigen::VectorXd known_weight, known_rest;
};

/// X' R X (m x m) for the covariance R of what the residual came from, X = `rows.J`. R is that of noise of y that is a
/// first-order autoregression, and of a load at the plant's input that wanders as a random walk: gain and time
/// constants follow such a load, so little of it is left in the residual.
///
/// There is one matrix for each pair of the autoregression's coefficient and the load's strength that the residual does
/// not tell from the likeliest one. The likelihood leaves the degrees of freedom that the fit took away out of account
/// (restricted maximum likelihood: Patterson and Thompson 1971). None for fewer than some 30 rows, or where
/// the residual is 0.
std::vector<Eigen::MatrixXd> weighed_with_load(const Fit& fit, const FittedRows& rows);

}  // namespace tunewright
