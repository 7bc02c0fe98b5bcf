#include "engine/structure/structured_peak.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

namespace tunewright::structure {
namespace {

using Eigen::Index;
using Matrix = Eigen::Ref<const Eigen::MatrixXcd>;
// On the stack: at most three rows.
using SmallMatrix = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
using SmallReal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using ComplexVector = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 1, 0, 3, 1>;

constexpr int kMostSteps = 60;
constexpr double kConverged = 1e-12;  // of ln of the value: the decrease that the slope promises
constexpr double kShortest = 1e-6;    // of a step
constexpr double kEnough = 1e-4;      // of the promised decrease
constexpr int kSweeps = 3;

SmallMatrix scaled(const Matrix& S, const Vector& d) {
    const Vector scale = d.array().exp();
    return scale.asDiagonal() * S * scale.cwiseInverse().asDiagonal();
}

/// ln of the largest singular value of D S D^-1, D = exp(diag(d)), and its gradient over d.
double log_value(const Matrix& S, const Vector& d, Vector& gradient) {
    const SmallMatrix A = scaled(S, d);
    const Eigen::SelfAdjointEigenSolver<SmallMatrix> solver(A.adjoint() * A);
    const Index last = A.rows() - 1;
    const double square = std::max(solver.eigenvalues()(last), 1e-300);
    const ComplexVector v = solver.eigenvectors().col(last), u = A * v / std::sqrt(square);
    gradient = u.cwiseAbs2() - v.cwiseAbs2();
    return 0.5 * std::log(square);
}

double of_two(const Matrix& S) {
    const double f = std::norm(S(0, 0)) + std::norm(S(1, 1)) + 2 * std::abs(S(0, 1) * S(1, 0));
    const double det = std::norm(S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
    return std::sqrt(0.5 * (f + std::sqrt(std::max(0.0, f * f - 4 * det))));
}

/// A start: off the diagonal each row and its column get the same size (Osborne 1960, Journal of the ACM 7, 338).
Vector balancing(const Matrix& S) {
    Vector d = Vector::Zero(S.rows());
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (Index i = 0; i < S.rows(); ++i) {
            const SmallMatrix A = scaled(S, d);
            const double own = std::norm(A(i, i)), row = A.row(i).squaredNorm() - own,
                         column = A.col(i).squaredNorm() - own;
            if (row > 0 && column > 0) d[i] += 0.25 * std::log(column / row);
        }
    return d;
}

/// Not below the largest singular value of D S D^-1: the root of the largest sums of a row and of a column.
double bound(const Matrix& S, const Vector& d) {
    const SmallReal size = scaled(S, d).cwiseAbs();
    return std::sqrt(size.rowwise().sum().maxCoeff() * size.colwise().sum().maxCoeff());
}

/// BFGS over d = ln D, whose last entry is kept: the function is convex there. Ends at a value that is not above
/// `least`.
double of_more(const Matrix& S, Vector& d, double least) {
    if (d.size() != S.rows()) d = balancing(S);
    if (const double value = bound(S, d); value <= least) return value;
    const double log_least = std::log(least);
    const Index n = S.rows() - 1;
    Vector gradient, next_gradient;
    double value = log_value(S, d, gradient);
    SmallReal inverse = SmallReal::Identity(n, n);
    for (int i = 0; i < kMostSteps && value > log_least; ++i) {
        const Vector p = -inverse * gradient.head(n);
        const double slope = p.dot(gradient.head(n));
        if (!(slope < -kConverged)) break;
        double t = 1, there = value;
        Vector next;
        for (; t > kShortest; t *= 0.4) {
            next = d;
            next.head(n) += t * p;
            there = log_value(S, next, next_gradient);
            if (there < value + kEnough * t * slope) break;
        }
        if (!(t > kShortest)) break;
        const Vector s = t * p, y = next_gradient.head(n) - gradient.head(n);
        if (const double sy = s.dot(y); sy > 0) {
            const SmallReal project = SmallReal::Identity(n, n) - s * y.transpose() / sy;
            inverse = (project * inverse * project.transpose() + s * s.transpose() / sy).eval();
        }
        d = next;
        value = there;
        gradient = next_gradient;
    }
    return std::exp(value);
}

}  // namespace

double structured_value(const Matrix& S) { return StructuredValues()(S); }

double StructuredValues::operator()(const Matrix& S) {
    if (S.rows() == 1) return std::abs(S(0, 0));
    if (S.rows() == 2) return of_two(S);
    return of_more(S, log_D_, least_);
}

}  // namespace tunewright::structure
