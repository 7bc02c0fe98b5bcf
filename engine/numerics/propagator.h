// Exact steps of x' = F x + G v + b for an input v that is a cubic polynomial within the step.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/numerics/columns.h"
#include "engine/numerics/cubic.h"

namespace tunewright {

/// One step of length h: x(h) = Phi x(0) + sum_j Gamma_j v_j + constant with v(s) = sum_j v_j s^j/j!.
struct ExactStep {
    double h = 0;
    std::size_t n = 0;
    /// n + 5 columns: those of Phi; Gamma_j, the integrals of e^(F (h - s)) G s^j/j!, j = 0 to 3; the constant, the
    /// integral of e^(F s) b. They are stored together, so that a step is one product; each has length().
    std::vector<double> columns;

    std::size_t length() const { return column_length(n); }
    std::span<const double> column(std::size_t k) const { return {columns.data() + k * length(), n}; }
    std::span<const double> Gamma(std::size_t j) const { return column(n + j); }
};

/// x := Phi x + Gamma v + constant.
inline void advance(const ExactStep& step, const Cubic& v, std::vector<double>& x) {
    const std::array<double, 5> inputs = {v[0], v[1], v[2], v[3], 1};
    map_columns(step.columns.data(), step.n, x, inputs);
}

/// The columns of `first` at its end, propagated by the states alone over `second`.
ColumnProduct carried_over(const ExactStep& second, const ExactStep& first, double* to);

/// row Phi for a row of n numbers.
std::vector<double> carried_over(const ExactStep& step, std::span<const double> row);

class Propagator {
public:
    /// `F`: n x n, row by row.
    Propagator(int n, const std::vector<double>& F, std::vector<double> G, std::vector<double> b, double h0);

    /// The step of length h0 2^level, computed once by doubling.
    const ExactStep& level(int level);
    /// The step of any length h > 0.
    ExactStep step(double h) const;
    /// A step of length first.h + second.h.
    ExactStep compose(const ExactStep& first, const ExactStep& second) const;

    /// True if it was made with these matrices.
    bool is_of(const std::vector<double>& F, const std::vector<double>& G, const std::vector<double>& b,
               double h0) const;

    int states() const { return n_; }
    double h0() const { return h0_; }

private:
    int n_;
    std::vector<double> F_, G_, b_;  // F in columns like those of ExactStep
    double h0_, norm_;
    std::vector<ExactStep> levels_;
};

}  // namespace tunewright
