#include "engine/identification/fit/nuisance.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/dense.h"

namespace tunewright {

Eigen::MatrixXd sample_rows(const Fit& fit) {
    const auto n = static_cast<Eigen::Index>(fit.residual.size());
    Eigen::MatrixXd J(n, static_cast<Eigen::Index>(fit.J.size()));
    for (std::size_t k = 0; k < fit.J.size(); ++k)
        J.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::VectorXd>(fit.J[k].data(), n);
    return J;
}

InputUnknowns joined(const InputUnknowns& one, const InputUnknowns& other) {
    if (one.deviation.size() == 0) return other;
    if (other.deviation.size() == 0) return one;
    InputUnknowns both;
    const Eigen::Index first = one.deviation.size(), count = first + other.deviation.size();
    both.slopes.resize(one.slopes.rows(), count);
    both.slopes << one.slopes, other.slopes;
    both.deviation.resize(count);
    both.deviation << one.deviation, other.deviation;
    both.rest.resize(count);
    both.rest << one.rest, other.rest;
    return both;
}

void take_out_unknowns(const InputUnknowns& unknowns, Fit& fit) {
    const Eigen::MatrixXd& N = unknowns.slopes;
    const Eigen::Index n = N.rows(), count = N.cols();
    if (count == 0 || fit.J.empty()) return;
    const auto rows = static_cast<Eigen::Index>(fit.J[0].size());
    const Eigen::MatrixXd J = sample_rows(fit);
    const double freedom = std::max(0.2 * static_cast<double>(n), static_cast<double>(n - J.cols()) - 0.5 * count);
    const double variance = std::max(kVarianceFloor, fit.sse / freedom);
    const Eigen::VectorXd known = std::sqrt(variance) * unknowns.deviation.cwiseInverse();
    const Eigen::VectorXd known_rest = known.cwiseProduct(unknowns.rest);
    const Eigen::MatrixXd seen = gram(N, N);
    Eigen::MatrixXd normal = seen;
    normal.diagonal() += known.cwiseAbs2();
    const Eigen::MatrixXd inverse = inverse_of(normal), explained = inverse * gram(N, J);
    const Eigen::MatrixXd taken = N * explained;
    for (std::size_t k = 0; k < fit.J.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        for (Eigen::Index i = 0; i < n; ++i) fit.J[k][static_cast<std::size_t>(i)] -= taken(i, column);
        fit.J[k].resize(static_cast<std::size_t>(rows + count));
        for (Eigen::Index i = 0; i < count; ++i)
            fit.J[k][static_cast<std::size_t>(rows + i)] = -known[i] * explained(i, column);
    }
    for (Eigen::Index k = 0; k < count; ++k) fit.nuisance.emplace_back(N.col(k).begin(), N.col(k).end());
    fit.nuisance_weight.assign(known.begin(), known.end());
    fit.nuisance_rest.assign(known_rest.begin(), known_rest.end());
    fit.nuisance_freedom = (inverse * seen).trace();
}

}  // namespace tunewright
