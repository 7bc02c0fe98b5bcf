#include "engine/numerics/eigenvalues.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright {
namespace {

using Matrix = Eigen::MatrixXd;
using Complex = std::complex<double>;

constexpr double kNoMarkovParameter = 1e-12;  // of the sum of its absolute terms: below it the parameter is rounding
constexpr double kRealZero = 1e-14;           // of a zero's size: below it its imaginary part is rounding

Matrix as_matrix(std::span<const double> rows, int n) {
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(rows.data(), n, n);
}

}  // namespace

std::optional<std::vector<Complex>> transmission_zeros(std::span<const double> A, std::span<const double> B,
                                                       std::span<const double> C, double D, int n) {
    // The relative degree is that of the first Markov parameter that is not rounding.
    const Matrix a = as_matrix(A, n);
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(B.data(), n);
    const Eigen::VectorXd c = Eigen::Map<const Eigen::VectorXd>(C.data(), n);
    int relative_degree = 0;
    if (D == 0) {
        Eigen::VectorXd power = b, magnitude = b.cwiseAbs();
        for (relative_degree = 1; relative_degree <= n; ++relative_degree) {
            if (std::abs(c.dot(power)) > kNoMarkovParameter * c.cwiseAbs().dot(magnitude)) break;
            power = a * power;
            magnitude = a.cwiseAbs() * magnitude;
        }
        if (relative_degree > n) return std::nullopt;
    }
    if (relative_degree == n) return std::vector<Complex>{};

    const double b_scale = std::max(b.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    const double c_scale = std::max(c.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    const double a_scale = std::max(a.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    Matrix pencil = Matrix::Zero(n + 1, n + 1), descriptor = Matrix::Zero(n + 1, n + 1);
    pencil.topLeftCorner(n, n) = a / a_scale;
    pencil.topRightCorner(n, 1) = b / b_scale;
    pencil.bottomLeftCorner(1, n) = c.transpose() / c_scale;
    pencil(n, n) = D * a_scale / (b_scale * c_scale);
    descriptor.topLeftCorner(n, n).setIdentity();
    const Eigen::GeneralizedEigenSolver<Matrix> solver(pencil, descriptor, false);
    std::vector<Complex> finite;
    for (Eigen::Index i = 0; i <= n; ++i)
        if (solver.betas()[i] != 0) finite.push_back(solver.alphas()[i] / solver.betas()[i] * a_scale);
    // Infinite eigenvalues come out huge rather than infinite: as many as there are zeros are kept, the smallest.
    std::sort(finite.begin(), finite.end(), [](Complex x, Complex y) { return std::abs(x) < std::abs(y); });
    if (static_cast<int>(finite.size()) > n - relative_degree)
        finite.resize(static_cast<std::size_t>(n - relative_degree));
    std::vector<Complex> result;
    for (const Complex zero : finite) {
        if (std::abs(zero.imag()) <= kRealZero * std::abs(zero)) {
            result.emplace_back(zero.real());
        } else if (zero.imag() > 0) {
            result.push_back(zero);
            result.push_back(std::conj(zero));
        }
    }
    return result;
}

}  // namespace tunewright
