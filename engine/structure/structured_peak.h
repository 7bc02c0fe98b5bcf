// The structured singular value of a matrix for one complex gain in each row.
#pragma once

#include <Eigen/Core>

namespace tunewright::structure {

/// mu of a complex matrix of one to three rows: the least largest singular value of D S D^-1 over positive diagonal D,
/// which is exact for up to three blocks (Packard and Doyle 1993, Automatica 29, 71-109). For two rows in closed form.
double structured_value(const Eigen::Ref<const Eigen::MatrixXcd>& S);

/// Values of matrices that change little from one to the next: begins with the last D.
class StructuredValues {
public:
    double operator()(const Eigen::Ref<const Eigen::MatrixXcd>& S);

private:
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> log_D_;
};

}  // namespace tunewright::structure
