#include "engine/numerics/chebyshev.h"

#include <cmath>
#include <numbers>

namespace tunewright {

Eigen::MatrixXd chebyshev_differentiation(int N, double L) {
    Eigen::VectorXd x(N + 1);
    for (int i = 0; i <= N; ++i) x[i] = 0.5 * L * (std::cos(std::numbers::pi * i / N) - 1);
    const auto weight = [N](int i) { return (i == 0 || i == N ? 2.0 : 1.0) * (i % 2 == 0 ? 1 : -1); };
    Eigen::MatrixXd D(N + 1, N + 1);
    for (int i = 0; i <= N; ++i) {
        double diagonal = 0;
        for (int j = 0; j <= N; ++j) {
            if (i == j) continue;
            D(i, j) = weight(i) / weight(j) / (x[i] - x[j]);
            diagonal -= D(i, j);
        }
        D(i, i) = diagonal;
    }
    return D;
}

}  // namespace tunewright
