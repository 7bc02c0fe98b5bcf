// One equation fewer than unknowns, whose solutions are the curve of steady states.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/range/equations/steady_branch.h"

namespace tunewright::range {

/// z = (x, u), or (x, u, p) with y or u held. Values in the user's units; steps and residuals are scaled by the sizes
/// that the unknowns and the equations' terms have.
class SteadyCurve {
public:
    /// `start`: a steady state, whose y or u is held along a parameter.
    SteadyCurve(const NonlinearSystem& system, const EquationsRange& range, const SteadyState& start);

    std::size_t unknowns() const { return n_ + (parameter_ ? 2 : 1); }

    /// The scheduling variable and its gradient.
    double place(std::span<const double> z) const;
    std::vector<double> place_gradient(std::span<const double> z) const;

    /// The unit tangent, in sizes of the unknowns, that turns least from `before` (also in those sizes); empty where
    /// the equations do not exist or the curve has no one tangent.
    std::optional<std::vector<double>> tangent(std::span<const double> z, std::span<const double> sizes,
                                               std::span<const double> before) const;

    /// Newton's method from z, with the last equation row . (z' - target) = 0 in sizes of the unknowns. The number of
    /// iterations; empty where it does not converge or the equations end.
    std::optional<int> correct_across(std::vector<double>& z, std::span<const double> sizes,
                                      std::span<const double> row, std::span<const double> target) const;

    /// Newton's method from z onto a place.
    bool correct_to_place(std::vector<double>& z, std::span<const double> sizes, double at) const;

    /// Sizes of the unknowns at z: what they are, at least a thousandth of the largest that they have been, which is
    /// kept in `largest` (empty at first).
    std::vector<double> sizes(std::span<const double> z, std::vector<double>& largest) const;

    SteadyState state(std::span<const double> z) const;
    std::vector<double> z(const SteadyState& state) const;

private:
    /// F and dF/dz (row by row); false where they do not exist.
    bool equations(std::span<const double> z, std::vector<double>& F, std::vector<double>& J) const;
    void split(std::span<const double> z, std::vector<double>& x, double& u) const;

    const NonlinearSystem& system_;
    Along along_;
    bool parameter_, hold_output_;
    std::size_t n_;  // states of the plant itself
    double y_held_, u_held_;
};

}  // namespace tunewright::range
