#include "engine/numerics/matrix/transmission_zeros.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright {
namespace {

using Matrix = Eigen::MatrixXd;
using Complex = std::complex<double>;

constexpr double kNoMarkovParameter = 1e-12;  // of the sum of its absolute terms: a smaller parameter is rounding
constexpr double kRealZero = 1e-14;           // of a zero's size: a smaller imaginary part is rounding

Matrix as_matrix(std::span<const double> rows, int n) {
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(rows.data(), n, n);
}

// The finite eigenvalues from the generalised Schur form (Golub and Van Loan 2013, section 7.7): quotients of the
// diagonals, and for each 2 x 2 block the eigenvalues of S/T. The library's own solver gives the same but takes twice
// as long to compile.
std::vector<Complex> finite_eigenvalues(const Matrix& pencil, const Matrix& descriptor) {
    const Eigen::RealQZ<Matrix> qz(pencil, descriptor, false);
    const Matrix& S = qz.matrixS();
    const Matrix& T = qz.matrixT();
    std::vector<Complex> finite;
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
        const bool pair = i + 1 < S.rows() && S(i + 1, i) != 0;
        if (!pair) {
            if (T(i, i) != 0) finite.emplace_back(S(i, i) / T(i, i));
            continue;
        }
        // T is diagonal here.
        const double a = S(i, i) / T(i, i), b = S(i, i + 1) / T(i + 1, i + 1), c = S(i + 1, i) / T(i, i),
                     d = S(i + 1, i + 1) / T(i + 1, i + 1);
        const double half = (a - d) / 2, imaginary = std::sqrt(std::abs(half * half + b * c));
        finite.emplace_back(d + half, imaginary);
        finite.emplace_back(d + half, -imaginary);
        ++i;
    }
    return finite;
}

}  // namespace

std::optional<std::vector<Complex>> transmission_zeros(std::span<const double> A, std::span<const double> B,
                                                       std::span<const double> C, double D, int n) {
    // The relative degree is the index of the first Markov parameter that is not rounding.
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
    std::vector<Complex> finite = finite_eigenvalues(pencil, descriptor);
    for (Complex& zero : finite) zero *= a_scale;
    // Infinite eigenvalues are computed as huge ones: the smallest are kept, as many as there are zeros.
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
