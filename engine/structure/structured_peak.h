// The structured singular value of a matrix for one complex gain in each row.
#pragma once

#include <Eigen/Core>

namespace tunewright::structure {

/// mu of a complex matrix of one to three rows: the least largest singular value of D S D^-1 over positive diagonal D,
/// which is exact for up to three blocks (Packard and Doyle 1993, Automatica 29, 71-109). For two rows in closed form.
double structured_value(const Eigen::Ref<const Eigen::MatrixXcd>& S);

}  // namespace tunewright::structure
