#include "engine/check/pace/loop_law.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tunewright::check {
namespace {

constexpr int kSpans[] = {1, 3, 10, 30};  // rows
constexpr double kClearlyBetter = 0.002;  // of the share explained: for a longer span

}  // namespace

LoopLaw loop_law(std::span<const double> error, std::span<const double> output, double step) {
    LoopLaw best;
    const std::size_t n = output.size();
    std::vector<double> sum(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) sum[i] = (i > 0 ? sum[i - 1] : 0) + error[i];
    for (const int rows : kSpans) {
        const auto M = static_cast<std::size_t>(rows);
        if (n < 10 * M) break;
        Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        double squares = 0, total = 0;
        for (std::size_t i = M; i < n; ++i) {
            const double du = output[i] - output[i - M], de = error[i] - error[i - M];
            const Eigen::Vector3d x(de, (sum[i] - sum[i - M] - 0.5 * de) * step, 1);
            A += x * x.transpose();
            b += x * du;
            squares += du * du;
            total += du;
        }
        const double count = double(n - M), variance = squares - total * total / count;
        if (!(variance > 0)) continue;
        if (!(A.diagonal().minCoeff() > 0)) continue;  // a constant error shows no law
        const Eigen::Vector3d scale = A.diagonal().cwiseSqrt();
        const Eigen::Matrix3d scaled =
            (A.array() / (scale * scale.transpose()).array()).matrix() + 1e-10 * Eigen::Matrix3d::Identity();
        const Eigen::Matrix3d inverse = scaled.inverse();
        const Eigen::Vector3d x = (inverse * b.cwiseQuotient(scale)).cwiseQuotient(scale);
        const double left = squares - 2 * x.dot(b) + x.dot(A * x);
        const double explained = 1 - std::max(0.0, left) / variance;
        if (!(explained > best.explained + kClearlyBetter)) continue;
        best = {.gain = x[0],
                .Ti = x[1] != 0 ? x[0] / x[1] : std::numeric_limits<double>::infinity(),
                .explained = explained};
        // Differences over M rows overlap: only every M-th is independent.
        const double noise = std::sqrt(std::max(0.0, left) / count * double(M));
        const auto relative_error = [&](int k) {
            return noise * std::sqrt(inverse(k, k)) / (scale[k] * std::abs(x[k]) + 1e-300);
        };
        best.gain_error = relative_error(0);
        best.Ti_error = std::hypot(best.gain_error, relative_error(1));
    }
    return best;
}

}  // namespace tunewright::check
