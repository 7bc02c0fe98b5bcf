#include "engine/identification/fit/load_doubt.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

constexpr int kWalkSteps = 16;  ///< steps of the random walk: a load that matters is slow

/// Responses of y to steps of the load, spread evenly over the record; together they form a random walk whose end has a
/// standard deviation of 1 from its start.
Eigen::MatrixXd responses(const Fit& fit, const Eigen::VectorXd& t) {
    ModelShape plant = fit.shape;
    plant.p[0] = 0;
    const bool zero = fit.form.gains() == 2;
    const double spacing = (t[t.size() - 1] - t[0]) / kWalkSteps;
    Eigen::MatrixXd G(t.size(), kWalkSteps);
    UnitResponse response;
    for (int k = 0; k < kWalkSteps; ++k) {
        const double time[] = {std::max(0.0, t[0] + (k + 0.5) * spacing)}, level[] = {std::sqrt(1.0 / kWalkSteps)};
        unit_response({t.data(), static_cast<std::size_t>(t.size())}, {time, level}, plant, zero ? 1 : 0, response);
        G.col(k) = fit.linear[0] * Eigen::Map<const Eigen::VectorXd>(response.x.data(), t.size());
        if (zero) G.col(k) += fit.linear[1] * Eigen::Map<const Eigen::VectorXd>(response.x1.data(), t.size());
    }
    return G;
}

/// x_k - a x_(k-1) in place of x_k: white if x is such an autoregression, with the same variance in the first row.
Eigen::MatrixXd whitened(const Eigen::MatrixXd& X, double a) {
    Eigen::MatrixXd W = X;
    W.bottomRows(X.rows() - 1) -= a * X.topRows(X.rows() - 1);
    W.row(0) *= std::sqrt(1 - a * a);
    return W;
}

/// White noise of variance `noise` as the input of the autoregression, and a load of variance q = `load`.
struct Strengths {
    double a = 0, noise = 0, load = 0;
    double unlikeliness = INFINITY;  ///< minus twice the logarithm of the restricted likelihood
};

/// The likeliest strengths, if `z` are independent with variance noise (1 + ratio s_i), and `others` values with the
/// sum of squares `rest` have the variance noise.
Strengths likeliest(const Eigen::VectorXd& z, const Eigen::VectorXd& s, double rest, double others) {
    constexpr int kPoints = 24;
    const double n = others + static_cast<double>(z.size());
    Strengths best;
    for (int k = 0; k < kPoints; ++k) {
        // 0, then from the ratio that adds to the noise a tenth of its variance in the direction that the load changes
        // most, up to a million times its variance.
        const double ratio = k == 0 ? 0 : 0.1 * std::pow(1e7, (k - 1.0) / (kPoints - 2.0)) / s.maxCoeff();
        const Eigen::ArrayXd variance = 1 + ratio * s.array();
        const double noise = (rest + (z.array().square() / variance).sum()) / n;
        const double value = n * std::log(noise) + variance.log().sum();
        if (value < best.unlikeliness) best = {0, noise, ratio * noise, value};
    }
    return best;
}

Strengths likeliest(const FittedRows& rows, const Eigen::MatrixXd& G, double a) {
    const Eigen::Index samples = rows.J.rows(), k = rows.nuisance.cols(), n = samples + k, m = rows.J.cols() + k;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, m), both = Eigen::MatrixXd::Zero(n, kWalkSteps + 1);
    J.topLeftCorner(samples, rows.J.cols()) = whitened(rows.J, a);
    both.topLeftCorner(samples, kWalkSteps) = whitened(G, a);
    both.topRightCorner(samples, 1) = whitened(rows.residual, a);
    if (k > 0) {
        J.topRightCorner(samples, k) = whitened(rows.nuisance, a);
        J.bottomLeftCorner(k, rows.J.cols()) = rows.known_J;
        J.bottomRightCorner(k, k) = rows.known_weight.asDiagonal();
        both.bottomRightCorner(k, 1) = rows.known_rest;
    }
    const Reflected turned = reflected(J, both);
    const Eigen::MatrixXd seen = turned.B.bottomLeftCorner(n - m, kWalkSteps);
    const Eigen::VectorXd e = turned.B.col(kWalkSteps).tail(n - m);
    const PrincipalAxes axes = principal_axes(gram(seen, seen));
    // In ascending order: only the last `used` are above rounding.
    constexpr double kMinRelativeEigenvalue = 1e-10;  // of the largest eigenvalue
    const double enough = kMinRelativeEigenvalue * axes.values[kWalkSteps - 1];
    const auto used = (axes.values.array() > std::max(enough, 0.0)).count();
    if (used == 0) return {};
    const Eigen::VectorXd s = axes.values.tail(used);
    const Eigen::VectorXd z =
        transpose_times(axes.vectors.rightCols(used), transpose_times(seen, e)).array() / s.array().sqrt();
    constexpr double kMinLogArgument = 1e-150;  // keeps the logarithm of a value near 0 finite
    constexpr double kMinRelativeRest = 1e-12;  // of the squares: a smaller difference is rounding
    const double rest = std::max(e.squaredNorm() - z.squaredNorm(), kMinRelativeRest * e.squaredNorm());
    Strengths best = likeliest(z, s, rest, static_cast<double>(n - m - used));
    best.a = a;
    best.unlikeliness -=
        std::log(1 - a * a) - 2 * turned.diagonal.head(m).array().abs().max(kMinLogArgument).log().sum();
    return best;
}

/// J'RJ for the found strengths; `pulls` is J'G.
Eigen::MatrixXd weighed(const Eigen::MatrixXd& J, const Eigen::MatrixXd& pulls, const Strengths& found) {
    // The noise's covariance is noise/(1 - a^2) a^|i - j|.
    Eigen::MatrixXd coloured = J;
    for (Eigen::Index k = 1; k < J.rows(); ++k) coloured.row(k) += found.a * coloured.row(k - 1);
    const Eigen::MatrixXd forward = gram(J, coloured);
    const Eigen::MatrixXd noise = forward + forward.transpose() - gram(J, J);
    return found.noise / (1 - found.a * found.a) * noise + found.load * pulls * pulls.transpose();
}

}  // namespace

std::vector<Eigen::MatrixXd> weighed_with_load(const Fit& fit, const FittedRows& rows) {
    constexpr double kMaxUnlikeliness = 2;  // of minus twice the logarithm of the likelihood
    const Eigen::Index n = rows.residual.size(), m = rows.J.cols();
    constexpr int kFreedom = 8;  // rows in addition to the unknowns, needed to estimate the strengths
    if (n < m + kWalkSteps + kFreedom || !(rows.residual.squaredNorm() > 0)) return {};
    const Eigen::MatrixXd G = rows.weight.asDiagonal() * responses(fit, rows.time);
    // The likelihood has a single maximum over a: once it is much less likely, the search ends.
    std::vector<Strengths> found;
    double min = INFINITY;
    for (const double a : {0.0, 0.3, 0.55, 0.75, 0.88, 0.95}) {
        found.push_back(likeliest(rows, G, a));
        if (found.back().unlikeliness > min + kMaxUnlikeliness) break;
        min = std::min(min, found.back().unlikeliness);
    }
    const Eigen::MatrixXd pulls = gram(rows.J, G);
    std::vector<Eigen::MatrixXd> all;
    for (const Strengths& one : found) {
        if (std::isfinite(one.unlikeliness) && one.unlikeliness <= min + kMaxUnlikeliness)
            all.push_back(weighed(rows.J, pulls, one));
    }
    return all;
}

}  // namespace tunewright
