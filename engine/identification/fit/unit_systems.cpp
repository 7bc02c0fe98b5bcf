#include "engine/identification/fit/unit_systems.h"

#include <Eigen/Core>

namespace tunewright::unit_systems {

QuadraticDecay::QuadraticDecay(double a1, double a2) : a2_(a2), sigma_(a1 / (2 * a2)) {
    const double square = sigma_ * sigma_ - 1 / a2;
    // Nearly equal roots count as equal: the relative error of the response is below 1e-12.
    constexpr double kEqual = 1e-13;
    const double w2 = std::abs(square) < kEqual * sigma_ * sigma_ ? 0 : square;
    w_ = std::sqrt(std::abs(w2));
    kind_ = w2 == 0 ? Kind::equal : w2 > 0 ? Kind::real : Kind::complex;
    slow_ = 1 / (a2 * (sigma_ + w_));
}

/// By a Taylor series over a part with norm below 1/2, then repeated squaring; the terms end below 1e-17.
StateMatrix<3> CubicDecay::over(double dt) const {
    const double w = 1 / std::sqrt(a2);
    Eigen::Matrix3d M;
    M << 0, w, 0, -w, -a1 / a2, 0, 1 / T3, 0, -1 / T3;
    M *= dt;
    const double norm = M.cwiseAbs().rowwise().sum().maxCoeff();
    int halvings = 0;
    std::frexp(norm, &halvings);
    halvings = std::max(0, halvings + 1);
    M *= std::ldexp(1.0, -halvings);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
    for (int k = 14; k > 0; --k) sum = Eigen::Matrix3d::Identity() + M * sum / k;
    for (; halvings > 0; --halvings) sum = (sum * sum).eval();
    StateMatrix<3> out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = sum(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    return out;
}

}  // namespace tunewright::unit_systems
