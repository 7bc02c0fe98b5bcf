#include "engine/identification/fit/residual_noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

constexpr std::size_t kBlocks = 80;  ///< enough means for a first-order model, few enough to be slow

constexpr std::size_t kMeansForEach = 4;  ///< means for each parameter: enough to correct its effect on slow noise

constexpr double kMinVariance = 1e-150;        ///< keeps the logarithm of a value near 0 finite
constexpr std::size_t kMaxSeriesLengths = 20;  ///< multiple of the series' length up to which an impulse response near
                                               ///< the unit circle is followed
constexpr std::size_t kMinAnswerSteps = 8;     ///< steps of an impulse response before it may count as decayed
constexpr double kMaxFadedShare = 1e-6;        ///< of the impulse: two successive values below it end the response
constexpr double kMinAddedShare = 1e-12;       ///< of the sum so far: rows that add less are omitted

/// Burg's estimates of the orders 0 to `highest`, or fewer if the series is short.
std::vector<Autoregression> burg(std::span<const double> e, std::size_t highest) {
    const std::size_t n = e.size();
    std::vector<double> forward(e.begin(), e.end()), backward(e.begin(), e.end());
    double variance = 0;
    for (const double value : e) variance += value * value / static_cast<double>(n);
    std::vector<Autoregression> orders = {{{}, std::sqrt(variance)}};
    for (std::size_t k = 1; k <= highest && k + 4 < n; ++k) {
        double cross = 0, squares = 0;
        for (std::size_t i = k; i < n; ++i) {
            cross += forward[i] * backward[i - 1];
            squares += forward[i] * forward[i] + backward[i - 1] * backward[i - 1];
        }
        if (!(squares > 0)) break;
        const double reflection = 2 * cross / squares;
        const std::vector<double>& before = orders.back().a;
        std::vector<double> a(before);
        for (std::size_t i = 0; i < before.size(); ++i) a[i] = before[i] - reflection * before[before.size() - 1 - i];
        a.push_back(reflection);
        for (std::size_t i = n; i-- > k;) {
            const double f = forward[i], b = backward[i - 1];
            forward[i] = f - reflection * b;
            backward[i] = b - reflection * f;
        }
        variance *= 1 - reflection * reflection;
        orders.push_back({std::move(a), std::sqrt(variance)});
    }
    return orders;
}

/// Burg's estimate of the order with the least Akaike criterion.
Autoregression autoregression(std::span<const double> e, std::size_t highest) {
    const auto n = static_cast<double>(e.size());
    const std::vector<Autoregression> orders = burg(e, highest);
    const auto criterion = [&](const Autoregression& model) {
        return 2 * n * std::log(std::max(model.innovation, kMinVariance)) + 2 * static_cast<double>(model.a.size());
    };
    return *std::ranges::min_element(orders, {}, criterion);
}

/// Corrects for slow noise that the fit has removed: the coefficient of a first order rises, the innovations do not
/// change.
void correct(std::vector<double>& a, double n, int parameters) {
    if (a.empty() || a[0] <= 0) return;
    const double max = 1 - 3 / n, m = parameters;
    a[0] = std::max(a[0], std::min(max, a[0] + (m + (m + 2) * a[0]) / n));
}

/// Means over blocks of rows; the last block may be shorter.
Eigen::MatrixXd block_means(const Eigen::MatrixXd& X, Eigen::Index block) {
    const Eigen::Index count = (X.rows() + block - 1) / block;
    Eigen::MatrixXd means(count, X.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index rows = std::min(block, X.rows() - i * block);
        means.row(i) = X.middleRows(i * block, rows).colwise().mean();
    }
    return means;
}

/// The deviations of the rows of X from the means over their blocks.
Eigen::MatrixXd inside_blocks(const Eigen::MatrixXd& X, const Eigen::MatrixXd& means, Eigen::Index block) {
    Eigen::MatrixXd rest = X;
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
        for (Eigen::Index i = 0; i < X.rows(); ++i) rest(i, c) -= means(i / block, c);
    }
    return rest;
}

std::vector<double> values(const Eigen::MatrixXd& column) { return {column.data(), column.data() + column.size()}; }

}  // namespace

Autoregression::Gains Autoregression::gains(std::size_t n) const {
    Gains result;
    if (a.empty()) return result;
    std::vector<double> h = {1};
    for (std::size_t k = 1; k < kMaxSeriesLengths * n; ++k) {
        double value = 0;
        for (std::size_t i = 0; i < a.size() && i < k; ++i) value += a[i] * h[k - 1 - i];
        h.push_back(value);
        result.variance += value * value;
        if (k > kMinAnswerSteps && std::abs(value) < kMaxFadedShare && std::abs(h[k - 1]) < kMaxFadedShare) break;
    }
    const double rest = 1 - std::accumulate(a.begin(), a.end(), 0.0);
    result.time = std::max(1.0, 1 / (rest * rest * result.variance));
    return result;
}

Eigen::MatrixXd Autoregression::weighed(const Eigen::MatrixXd& X) const {
    const double variance = innovation * innovation;
    const auto order = static_cast<Eigen::Index>(a.size()), n = X.rows();
    if (order == 0) return variance * gram(X, X);
    // R = innovation^2 H H' with H the impulse response: H' is the same filter backward in time, and its output before
    // the first row makes the noise stationary there.
    Eigen::MatrixXd Z = X;
    for (Eigen::Index c = 0; c < Z.cols(); ++c) {
        double* z = Z.col(c).data();
        for (Eigen::Index i = n; i-- > 0;) {
            for (Eigen::Index k = 1; k <= order && i + k < n; ++k)
                z[i] += a[static_cast<std::size_t>(k - 1)] * z[i + k];
        }
    }
    Eigen::MatrixXd product = gram(Z, Z), next = Z.topRows(std::min(order, n));
    const Eigen::Map<const Eigen::RowVectorXd> filter(a.data(), next.rows());
    const double enough = kMinAddedShare * product.diagonal().maxCoeff();
    Eigen::RowVectorXd row(X.cols());
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kMaxSeriesLengths) * n && next.row(0).squaredNorm() > enough;
         ++i) {
        row.noalias() = filter * next;
        for (Eigen::Index k = next.rows() - 1; k > 0; --k) next.row(k) = next.row(k - 1).eval();
        next.row(0) = row;
        product.noalias() += row.transpose() * row;
    }
    return variance * product;
}

double innovation_variance(std::span<const double> series) {
    const double deviation = autoregression(series, 3).innovation;
    return deviation * deviation;
}

ResidualNoise::ResidualNoise(std::span<const double> residual, int parameters, double min) {
    const std::size_t n = residual.size();
    const std::size_t blocks = std::max(kBlocks, kMeansForEach * static_cast<std::size_t>(parameters));
    block_ = static_cast<Eigen::Index>(std::max<std::size_t>(1, n / blocks));
    const Eigen::MatrixXd e = Eigen::Map<const Eigen::VectorXd>(residual.data(), static_cast<Eigen::Index>(n));
    const Eigen::MatrixXd means = block_means(e, block_);
    slow_ = autoregression(values(means), 1);
    correct(slow_.a, static_cast<double>(means.rows()), parameters);
    if (block_ > 1) fast_ = autoregression(values(inside_blocks(e, means, block_)), 3);
    const auto block = static_cast<double>(block_), count = static_cast<double>(n);
    // Each parameter uses a degree of freedom of the whole series; slow regressors use those of the means.
    slow_.innovation *=
        std::sqrt(std::min(4.0, means.rows() / std::max(1.0, static_cast<double>(means.rows()) - parameters)));
    const auto gains = slow_.gains(static_cast<std::size_t>(means.rows()));
    slow_.innovation = std::max(slow_.innovation, std::sqrt(min / block / gains.variance));
    long_run_ = block * slow_.innovation * slow_.innovation * gains.variance * gains.time;
    const double marginal = std::max(e.squaredNorm() / count, min);
    freedom_ = std::max(1.0, count / std::max(1.0, long_run_ / marginal) - parameters);
}

Eigen::MatrixXd ResidualNoise::weighed(const Eigen::MatrixXd& X) const {
    const Eigen::MatrixXd means = block_means(X, block_);
    const auto block = static_cast<double>(block_);
    Eigen::MatrixXd product = block * block * slow_.weighed(means);
    if (block_ == 1) return product;
    if (!fast_.a.empty()) return product + fast_.weighed(inside_blocks(X, means, block_));
    // White inside: deviations from the means need no rows of their own.
    Eigen::MatrixXd of_means = block * gram(means, means);
    const double last = static_cast<double>(X.rows()) - block * static_cast<double>(means.rows() - 1);
    of_means += (last - block) * means.bottomRows(1).transpose() * means.bottomRows(1);
    return product + fast_.innovation * fast_.innovation * (gram(X, X) - of_means);
}

double student_factor(double freedom) {
    constexpr double z = 1.959964;
    const double v = std::max(freedom, 2.0);
    const double t = z + (z * z * z + z) / (4 * v) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * v * v);
    return t / z;
}

}  // namespace tunewright
