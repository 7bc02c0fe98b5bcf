// The structured singular value of a matrix for one complex gain in each row.
#pragma once

#include <Eigen/Core>

namespace tunewright::structure {

/// mu of a complex matrix of one to three rows: the least largest singular value of D S D^-1 over positive diagonal D,
/// which is exact for up to three blocks (Packard and Doyle 1993, Automatica 29, 71-109). For two rows in closed form.
double structured_value(const Eigen::Ref<const Eigen::MatrixXcd>& S);

/// Values of matrices that change little from one to the next: begins with the last D. A value that is not above
/// `least` may be any upper bound of mu that is not either, which costs a fraction.
class StructuredValues {
public:
    explicit StructuredValues(double least = 0) : least_(least) {}

    double operator()(const Eigen::Ref<const Eigen::MatrixXcd>& S);

private:
    double least_;
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> log_D_;
};

}  // namespace tunewright::structure
