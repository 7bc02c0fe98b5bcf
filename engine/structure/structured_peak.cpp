#include "engine/structure/structured_peak.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tunewright::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Matrix = Eigen::Ref<const MatrixXcd>;

constexpr int kMostSteps = 60;
constexpr double kConverged = 1e-11;  // of ln of the value

/// ln of the largest singular value of D S D^-1, D = exp(diag(d)), and its gradient over d.
double log_value(const Matrix& S, const Eigen::VectorXd& d, Eigen::VectorXd& gradient) {
    const Eigen::VectorXd scale = d.array().exp();
    const MatrixXcd A = scale.asDiagonal() * S * scale.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(A.adjoint() * A);
    const Index last = A.rows() - 1;
    const double square = std::max(solver.eigenvalues()(last), 1e-300);
    const Eigen::VectorXcd v = solver.eigenvectors().col(last), u = A * v / std::sqrt(square);
    gradient = u.cwiseAbs2() - v.cwiseAbs2();
    return 0.5 * std::log(square);
}

double of_two(const Matrix& S) {
    const double f = std::norm(S(0, 0)) + std::norm(S(1, 1)) + 2 * std::abs(S(0, 1) * S(1, 0));
    const double det = std::norm(S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
    return std::sqrt(0.5 * (f + std::sqrt(std::max(0.0, f * f - 4 * det))));
}

/// Steepest descent over ln D with steps that adapt: the function is convex there.
double of_more(const Matrix& S) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(S.rows()), gradient, next_gradient;
    double value = log_value(S, d, gradient), step = 0.5;
    for (int i = 0; i < kMostSteps && step > 1e-9; ++i) {
        const Eigen::VectorXd next = d - step * gradient;
        const double there = log_value(S, next, next_gradient);
        if (there < value) {
            const bool done = value - there < kConverged;
            d = next;
            value = there;
            gradient = next_gradient;
            step *= 1.6;
            if (done) break;
        } else {
            step *= 0.4;
        }
    }
    return std::exp(value);
}

}  // namespace

double structured_value(const Matrix& S) {
    if (S.rows() == 1) return std::abs(S(0, 0));
    return S.rows() == 2 ? of_two(S) : of_more(S);
}

}  // namespace tunewright::structure
