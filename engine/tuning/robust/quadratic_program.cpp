#include "engine/tuning/robust/quadratic_program.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tunewright::robust {
namespace {

constexpr int kMaxSize = 6;

/// Gaussian elimination with pivoting on [A | b], size at most 6. False: singular.
bool eliminate(std::array<std::array<double, kMaxSize + 1>, kMaxSize>& A, int size) {
    for (int k = 0; k < size; ++k) {
        int pivot = k;
        for (int i = k + 1; i < size; ++i)
            if (std::abs(A[std::size_t(i)][std::size_t(k)]) > std::abs(A[std::size_t(pivot)][std::size_t(k)]))
                pivot = i;
        if (std::abs(A[std::size_t(pivot)][std::size_t(k)]) < 1e-13) return false;
        std::swap(A[std::size_t(k)], A[std::size_t(pivot)]);
        for (int i = 0; i < size; ++i) {
            if (i == k) continue;
            const double factor = A[std::size_t(i)][std::size_t(k)] / A[std::size_t(k)][std::size_t(k)];
            for (int j = k; j <= size; ++j)
                A[std::size_t(i)][std::size_t(j)] -= factor * A[std::size_t(k)][std::size_t(j)];
        }
    }
    for (int k = 0; k < size; ++k) A[std::size_t(k)][std::size_t(size)] /= A[std::size_t(k)][std::size_t(k)];
    return true;
}

double dot(const Vector3& a, const Vector3& b, int n) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += a[std::size_t(i)] * b[std::size_t(i)];
    return sum;
}

/// The stationary point with the given constraints as equations; kept if it satisfies all others and pulls in the right
/// direction.
std::optional<QuadraticSolution> try_active_set(int n, const Matrix3& H, const Vector3& g,
                                                const std::vector<LinearConstraint>& constraints,
                                                const std::array<int, 3>& active, int count) {
    std::array<std::array<double, kMaxSize + 1>, kMaxSize> A{};
    const int size = n + count;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) A[std::size_t(i)][std::size_t(j)] = H[std::size_t(i)][std::size_t(j)];
        A[std::size_t(i)][std::size_t(size)] = -g[std::size_t(i)];
        for (int k = 0; k < count; ++k) {
            const double a = constraints[std::size_t(active[std::size_t(k)])].a[std::size_t(i)];
            A[std::size_t(i)][std::size_t(n + k)] = a;
            A[std::size_t(n + k)][std::size_t(i)] = a;
        }
    }
    for (int k = 0; k < count; ++k)
        A[std::size_t(n + k)][std::size_t(size)] = constraints[std::size_t(active[std::size_t(k)])].b;
    if (!eliminate(A, size)) return std::nullopt;
    QuadraticSolution solution;
    for (int i = 0; i < n; ++i) solution.p[std::size_t(i)] = A[std::size_t(i)][std::size_t(size)];
    for (int k = 0; k < count; ++k)
        if (A[std::size_t(n + k)][std::size_t(size)] < -1e-10) return std::nullopt;
    for (const auto& c : constraints)
        if (dot(c.a, solution.p, n) > c.b + 1e-9 * (1 + std::abs(c.b))) return std::nullopt;
    solution.multipliers.assign(constraints.size(), 0);
    for (int k = 0; k < count; ++k)
        solution.multipliers[std::size_t(active[std::size_t(k)])] =
            std::max(0.0, A[std::size_t(n + k)][std::size_t(size)]);
    return solution;
}

}  // namespace

std::optional<QuadraticSolution> solve_quadratic_program(int n, const Matrix3& H, const Vector3& g,
                                                         const std::vector<LinearConstraint>& constraints) {
    const int m = static_cast<int>(constraints.size());
    if (auto free = try_active_set(n, H, g, constraints, {}, 0)) return free;
    for (int i = 0; i < m; ++i)
        if (auto one = try_active_set(n, H, g, constraints, {i}, 1)) return one;
    for (int i = 0; i < m; ++i)
        for (int j = i + 1; j < m; ++j)
            if (auto two = try_active_set(n, H, g, constraints, {i, j}, 2)) return two;
    if (n < 3) return std::nullopt;
    for (int i = 0; i < m; ++i)
        for (int j = i + 1; j < m; ++j)
            for (int k = j + 1; k < m; ++k)
                if (auto three = try_active_set(n, H, g, constraints, {i, j, k}, 3)) return three;
    return std::nullopt;
}

}  // namespace tunewright::robust
