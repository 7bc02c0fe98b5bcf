// A linear program in at most three unknowns within [-1, 1] and many half-planes, by the dual simplex method.
#pragma once

#include <array>
#include <utility>
#include <vector>

namespace tunewright::certificate {

struct ProgramRow {
    std::array<double, 3> a{};
    double b = 0;  ///< a x >= b
};

struct ProgramResult {
    enum class Kind { solved, empty, failed } kind = Kind::failed;
    double least = 0;  ///< of c x; only if solved
    /// Rows with their multipliers > 0: of the optimum, or of a sum that no x fulfils.
    std::vector<std::pair<int, double>> multipliers;
};

/// min c x with a_r x >= b_r for each row and |x_i| <= 1, i < n <= 3. The result is only as exact as doubles are: its
/// multipliers are to be checked.
ProgramResult solve_small_program(int n, const std::array<double, 3>& c, const std::vector<ProgramRow>& rows);

}  // namespace tunewright::certificate
