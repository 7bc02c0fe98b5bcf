// Least squares on a few long columns: what of y they reach, and what of others.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace tunewright {

/// The columns' orthonormal basis and what they leave of y.
struct Projection {
    Eigen::MatrixXd basis;             ///< one column for each; 0 where it depends on those after it
    Eigen::VectorXd residual, linear;  ///< y - columns linear
    bool determined = true;            ///< the first column is independent of the others
    double sse = std::numeric_limits<double>::max();
};

double square_of(const Eigen::VectorXd& y);

/// y on the columns, of as many rows. `y_square`: square_of(y).
void project_on(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, double y_square, Projection& result);

/// What is left of y_square, roughly: by normal equations, good to the square root of the precision. May be below 0 by
/// rounding. At most kMaxSmallSize columns (dense.h).
double rough_rest(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, double y_square);

/// Takes out of D's columns what the basis reaches.
void take_out(const Eigen::MatrixXd& basis, Eigen::MatrixXd& D);

/// D'D and D'e.
struct NormalEquations {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd right;
};
NormalEquations normal_equations(const Eigen::MatrixXd& D, const Eigen::VectorXd& e);

}  // namespace tunewright
