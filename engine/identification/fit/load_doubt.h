// The possible effect on a fit of a load that changes slowly and was not noticed.
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
    /// Parameters that were also fitted and removed from J: their columns, n x k, and k rows of prior knowledge about
    /// them, which have `known_J` in J's columns, `known_weight` on the diagonal and the residual `known_rest`.
    Eigen::MatrixXd nuisance, known_J;
    Eigen::VectorXd known_weight, known_rest;
};

/// X' R X (m x m) for the covariance R of the sources of the residual, X = `rows.J`. R is that of noise of y, a
/// first-order autoregression, and of a load at the plant's input, a random walk. Gain and time constants follow such a
/// load, so the residual contains little of it.
///
/// There is one matrix for each pair of the autoregression's coefficient and the load's strength that the residual does
/// not distinguish from the likeliest one. The likelihood excludes the degrees of freedom of the fit (restricted
/// maximum likelihood: Patterson and Thompson 1971). Empty for fewer than about 30 rows, or if the residual is 0.
std::vector<Eigen::MatrixXd> weighed_with_load(const Fit& fit, const FittedRows& rows);

}  // namespace tunewright
