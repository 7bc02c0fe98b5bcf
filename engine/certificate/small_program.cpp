#include "engine/certificate/small_program.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace tunewright::certificate {
namespace {

using Vector = std::array<double, 3>;

constexpr int kMaxPivots = 60;
constexpr double kLeastViolation = 1e-11, kLeastPivot = 1e-12;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Three rows that hold with equality. Bounds have the negative numbers -1 - 2i (x_i >= -1) and -2 - 2i (x_i <= 1).
struct Vertex {
    std::array<int, 3> id{};
    std::array<Vector, 3> row{};
    Vector b{};

    /// The inverse of the matrix of rows, by columns; empty if it is singular.
    std::optional<std::array<Vector, 3>> inverse() const {
        std::array<Vector, 3> columns = {cross(row[1], row[2]), cross(row[2], row[0]), cross(row[0], row[1])};
        const double determinant = dot(row[0], columns[0]);
        if (!(std::abs(determinant) > 1e-200)) return std::nullopt;
        for (Vector& column : columns)
            for (double& x : column) x /= determinant;
        return columns;
    }
};

}  // namespace

ProgramResult solve_small_program(int n, const Vector& c, const std::vector<ProgramRow>& rows) {
    ProgramResult result;
    Vertex vertex;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool lower = i >= n || c[at] >= 0;
        vertex.id[at] = lower ? -1 - 2 * i : -2 - 2 * i;
        vertex.row[at][at] = lower ? 1 : -1;
        vertex.b[at] = i < n ? -1 : 0;  // an unknown that is not there is 0
    }
    for (int pivot = 0; pivot < kMaxPivots; ++pivot) {
        const auto columns = vertex.inverse();
        if (!columns) return result;
        Vector x{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) x[i] += (*columns)[k][i] * vertex.b[k];
        const auto components = [&](const Vector& v) {  // v = sum_k component_k row_k
            return Vector{dot((*columns)[0], v), dot((*columns)[1], v), dot((*columns)[2], v)};
        };
        double worst = -kLeastViolation;
        int entering = std::numeric_limits<int>::min();
        Vector row{};
        double b = 0;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const double slack = dot(rows[r].a, x) - rows[r].b;
            if (slack < worst) {
                worst = slack;
                entering = static_cast<int>(r);
                row = rows[r].a;
                b = rows[r].b;
            }
        }
        for (int i = 0; i < n; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (1 - std::abs(x[at]) >= worst) continue;
            worst = 1 - std::abs(x[at]);
            entering = x[at] < 0 ? -1 - 2 * i : -2 - 2 * i;
            row = {};
            row[at] = x[at] < 0 ? 1 : -1;
            b = -1;
        }
        const Vector mu = components(c);
        if (entering == std::numeric_limits<int>::min()) {
            result.kind = ProgramResult::Kind::solved;
            result.least = dot(c, x);
            for (std::size_t k = 0; k < 3; ++k)
                if (vertex.id[k] >= 0 && mu[k] > 0) result.multipliers.emplace_back(vertex.id[k], mu[k]);
            return result;
        }
        const Vector alpha = components(row);
        std::size_t leaving = 3;
        double ratio = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
            if (alpha[k] > kLeastPivot * (std::abs(alpha[0]) + std::abs(alpha[1]) + std::abs(alpha[2])) &&
                std::max(mu[k], 0.0) / alpha[k] < ratio) {
                ratio = std::max(mu[k], 0.0) / alpha[k];
                leaving = k;
            }
        }
        if (leaving == 3) {
            result.kind = ProgramResult::Kind::empty;
            if (entering >= 0) result.multipliers.emplace_back(entering, 1.0);
            for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k)
                if (vertex.id[k] >= 0 && alpha[k] < 0) result.multipliers.emplace_back(vertex.id[k], -alpha[k]);
            return result;
        }
        vertex.id[leaving] = entering;
        vertex.row[leaving] = row;
        vertex.b[leaving] = b;
    }
    return result;
}

}  // namespace tunewright::certificate
