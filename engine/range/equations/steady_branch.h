// The steady states of a nonlinear plant along its input, its output or a parameter: continuation, folds and jumps.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/range/problem.h"

namespace tunewright::range {

enum class Along { input, output, parameter };

/// The steady states over which a range of equations extends.
struct EquationsRange {
    NonlinearPlant plant;  ///< its operating point is the start of the continuation; it may be outside the range
    Along along = Along::output;
    std::string parameter = {};  ///< its name; it is given as a number and no other parameter depends on it
    double from = 0, to = 0;     ///< from < to: of u, y or the parameter, absolute
    bool hold_output = true;     ///< along a parameter: true: the input keeps y at its operating value; false: u is
                                 ///< constant
};

struct SteadyState {
    double at = 0;          ///< value of the scheduling variable
    std::vector<double> x;  ///< the plant's states, absolute
    double u = 0, y = 0, p = 0;
};

/// A point at which the branch turns back: beyond it there is no steady state nearby, and the plant jumps.
struct Fold {
    SteadyState state;
    bool upper = false;         ///< true: the scheduling variable has its maximum here, else its minimum
    std::vector<double> jumps;  ///< y of the other steady states at the same value on the followed branch
};

/// z = (x, u, p) on F(z) = 0, one equation fewer than unknowns: f(x, u, p) = 0, with y or u held along a parameter.
/// Pseudo-arclength continuation (Keller 1977; Allgower and Georg, Introduction to Numerical Continuation Methods,
/// 2003, chapter 6): the tangent predicts, Newton's method corrects in the plane orthogonal to it, with exact
/// Jacobians. The step lengths depend on how far the tangent turns.
class SteadyBranch {
public:
    /// Errors: those of NonlinearSystem::make; invalid_argument, `where` = "range/from", "range/to", "range/parameter",
    /// "range": an empty range; an unknown parameter or one that others are computed from; a fold inside the range (the
    /// message has its place, its effect and a possible range); the branch leaves the domain of the equations (with the
    /// operation that fails) or is longer than 2000 steps; a steady input beyond its limits.
    static Expected<SteadyBranch> follow(const EquationsRange& range);

    double low() const { return low_; }
    double high() const { return high_; }
    /// Ascending in `at`, from one end of the range to the other.
    const std::vector<SteadyState>& states() const { return states_; }
    /// Folds of the input along the branch, if the range is not along the input: between two of them the plant is
    /// unstable, or no constant input holds it.
    const std::vector<Fold>& input_folds() const { return input_folds_; }

    /// The steady state at a value of the scheduling variable, to rounding (about 1e-12 of the states). Error:
    /// numerical_failure.
    Expected<SteadyState> at(double place) const;

    /// The linearisation there, exact, with the dead time.
    StateSpace linearised(const SteadyState& state) const;

    /// The plant with its operating point at a steady state (and its parameter there).
    NonlinearPlant plant_at(const SteadyState& state) const;

    const EquationsRange& range() const { return range_; }
    /// The equations; along a parameter with an additional last state, which is the parameter and has the rate 0.
    const NonlinearSystem& system() const { return *system_; }
    /// Name of the scheduling variable: "CA", "Tj", ...
    std::string scheduling_name() const;

private:
    friend class BranchWalk;
    explicit SteadyBranch(EquationsRange range) : range_(std::move(range)) {}
    std::optional<Error> prepare();

    EquationsRange range_;
    std::shared_ptr<const NonlinearSystem> system_;
    double low_ = 0, high_ = 0;
    SteadyState start_;
    std::vector<SteadyState> states_;
    std::vector<Fold> input_folds_;
};

}  // namespace tunewright::range
