// Least squares on a few long columns: the part of y in their span and the residual, also for other columns.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace tunewright {

/// The orthonormal basis of the columns, and the residual of y.
struct Projection {
    Eigen::MatrixXd basis;             ///< one column for each; 0 if it depends on those after it
    Eigen::VectorXd residual, linear;  ///< y - columns linear
    bool determined = true;            ///< true: the first column is independent of the others
    double sse = std::numeric_limits<double>::max();
};

double square_of(const Eigen::VectorXd& y);

/// Projects y onto the columns, which have as many rows. `y_square`: square_of(y).
void project_on(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, double y_square, Projection& result);

/// An estimate of the residual's square: by normal equations, accurate to the square root of the precision. May be
/// below 0 by rounding. At most kMaxSmallSize columns (dense.h).
double rough_rest(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, double y_square);

/// Subtracts from D's columns their part in the span of the basis.
void take_out(const Eigen::MatrixXd& basis, Eigen::MatrixXd& D);

/// D'D and D'e.
struct NormalEquations {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd right;
};
NormalEquations normal_equations(const Eigen::MatrixXd& D, const Eigen::VectorXd& e);

}  // namespace tunewright
