#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/loop/delay_system.h"
#include "engine/loop/stability.h"
#include "engine/numerics/linear_algebra.h"

namespace tunewright {
namespace {

/// Chebyshev differentiation matrix on theta_0 = 0 > ... > theta_N = -L (Trefethen 2000, ch. 6).
std::vector<double> differentiation_matrix(int N, double L) {
    std::vector<double> x, D(static_cast<std::size_t>((N + 1) * (N + 1)));
    for (int i = 0; i <= N; ++i) x.push_back(0.5 * L * (std::cos(std::numbers::pi * i / N) - 1));
    const auto weight = [N](int i) { return (i == 0 || i == N ? 2.0 : 1.0) * (i % 2 == 0 ? 1 : -1); };
    for (int i = 0; i <= N; ++i) {
        double diagonal = 0;
        for (int j = 0; j <= N; ++j) {
            if (i == j) continue;
            const double d = weight(i) / weight(j) / (x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)]);
            D[static_cast<std::size_t>(i * (N + 1) + j)] = d;
            diagonal -= d;
        }
        D[static_cast<std::size_t>(i * (N + 1) + i)] = diagonal;
    }
    return D;
}

/// States x and the history w_1..w_N of the delayed signal (w_0 = M x + N w_N is not free): x' = F x + G w_N, w_i' =
/// sum D_ij w_j.
std::vector<double> discretised(const DelaySystem& s, int nodes) {
    const int size = s.n + nodes;
    std::vector<double> A(static_cast<std::size_t>(size * size), 0.0);
    const auto at = [&](int i, int j) -> double& { return A[static_cast<std::size_t>(i * size + j)]; };
    const int last = size - 1;
    for (int i = 0; i < s.n; ++i) {
        for (int j = 0; j < s.n; ++j) at(i, j) = s.F[static_cast<std::size_t>(i * s.n + j)];
        at(i, last) += s.G[static_cast<std::size_t>(i)];
    }
    const std::vector<double> D = differentiation_matrix(nodes, s.L);
    for (int i = 1; i <= nodes; ++i) {
        const int row = s.n + i - 1;
        const double d0 = D[static_cast<std::size_t>(i * (nodes + 1))];
        for (int j = 0; j < s.n; ++j) at(row, j) += d0 * s.M[static_cast<std::size_t>(j)];
        at(row, last) += d0 * s.N;
        for (int j = 1; j <= nodes; ++j) at(row, s.n + j - 1) += D[static_cast<std::size_t>(i * (nodes + 1) + j)];
    }
    return A;
}

}  // namespace

Expected<std::complex<double>> rightmost_pole(const Loop& loop, int nodes) {
    const DelaySystem system = make_delay_system(loop.plant(), loop.gains());
    std::vector<std::complex<double>> poles;
    if (system.L > 0) {
        poles = eigenvalues(discretised(system, nodes), system.n + nodes);
    } else {
        const DelaySystem closed = close_without_delay(system);
        poles = eigenvalues(closed.F, closed.n);
    }
    if (poles.empty())
        return Error{ErrorKind::numerical_failure, "",
                     "The loop has no poles that can be computed: it has no states, or its numbers are out of range."};
    return *std::max_element(poles.begin(), poles.end(), [](auto a, auto b) { return a.real() < b.real(); });
}

}  // namespace tunewright
