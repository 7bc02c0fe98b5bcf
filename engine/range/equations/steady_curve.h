// Equations, one fewer than unknowns, whose solutions are the curve of steady states.
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
    /// `start`: a steady state, whose y or u stays constant along a parameter.
    SteadyCurve(const NonlinearSystem& system, const EquationsRange& range, const SteadyState& start);

    std::size_t unknowns() const { return n_ + (parameter_ ? 2 : 1); }

    /// The scheduling variable and its gradient.
    double place(std::span<const double> z) const;
    std::vector<double> place_gradient(std::span<const double> z) const;

    /// The unit tangent, in sizes of the unknowns, that turns least from `before` (also in those sizes); empty if the
    /// equations are not defined or the tangent is not unique.
    std::optional<std::vector<double>> tangent(std::span<const double> z, std::span<const double> sizes,
                                               std::span<const double> before) const;

    /// Newton's method from z, with the last equation row . (z' - target) = 0 in sizes of the unknowns. Returns the
    /// number of iterations; empty if it does not converge or the equations are not defined.
    std::optional<int> correct_across(std::vector<double>& z, std::span<const double> sizes,
                                      std::span<const double> row, std::span<const double> target) const;

    /// Newton's method from z to the state with this value of the scheduling variable.
    bool correct_to_place(std::vector<double>& z, std::span<const double> sizes, double at) const;

    /// Sizes of the unknowns at z: their absolute values, but at least a thousandth of the largest that they have had,
    /// which is kept in `largest` (initially empty).
    std::vector<double> sizes(std::span<const double> z, std::vector<double>& largest) const;

    SteadyState state(std::span<const double> z) const;
    std::vector<double> z(const SteadyState& state) const;

private:
    /// F and dF/dz (row by row); false if they are not defined.
    bool equations(std::span<const double> z, std::vector<double>& F, std::vector<double>& J) const;
    void split(std::span<const double> z, std::vector<double>& x, double& u) const;

    const NonlinearSystem& system_;
    Along along_;
    bool parameter_, hold_output_;
    std::size_t n_;  // number of the plant's own states
    double y_held_, u_held_;
};

}  // namespace tunewright::range
