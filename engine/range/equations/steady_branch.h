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

/// Which steady states a range of equations goes through.
struct EquationsRange {
    NonlinearPlant plant;  ///< its operating point is where the continuation begins; it may lie outside the range
    Along along = Along::output;
    std::string parameter = {};  ///< its name; a number, in no other parameter's expression
    double from = 0, to = 0;     ///< from < to: of u, y or the parameter, absolute
    bool hold_output = true;     ///< along a parameter: the input keeps y at the operating point; false: u stays
};

struct SteadyState {
    double at = 0;          ///< of the scheduling variable
    std::vector<double> x;  ///< the plant's states, absolute
    double u = 0, y = 0, p = 0;
};

/// A place where the branch turns back: beyond it there is no steady state near, and the plant jumps.
struct Fold {
    SteadyState state;
    bool upper = false;         ///< the scheduling variable is largest here, else smallest
    std::vector<double> jumps;  ///< y of the other steady states at the same place that the branch was followed to
};

/// z = (x, u, p) on F(z) = 0, one equation fewer than unknowns: f(x, u, p) = 0, with y or u held along a parameter.
/// Pseudo-arclength continuation (Keller 1977; Allgower and Georg, Introduction to Numerical Continuation Methods,
/// 2003, chapter 6): the tangent predicts, Newton's method corrects in the plane across it; exact Jacobians. Steps
/// follow how far the tangent turns.
class SteadyBranch {
public:
    /// Errors: those of NonlinearSystem::make; invalid_argument, `where` = "range/from", "range/to", "range/parameter",
    /// "range": an empty range; an unknown parameter or one that others are computed from; a fold inside the range (the
    /// sentence says where, what happens there and how the range may be given); the branch ends because the equations
    /// do (with the operation that fails) or is longer than 2000 steps; a steady input beyond its limits.
    static Expected<SteadyBranch> follow(const EquationsRange& range);

    double low() const { return low_; }
    double high() const { return high_; }
    /// Ascending in `at`, from one end of the range to the other.
    const std::vector<SteadyState>& states() const { return states_; }
    /// Where the input turns back along the branch, if the range is not along it: between two such places the plant is
    /// unstable, or held by no constant input.
    const std::vector<Fold>& input_folds() const { return input_folds_; }

    /// The steady state at a place of the range, to rounding (about 1e-12 of the states). Error: numerical_failure.
    Expected<SteadyState> at(double place) const;

    /// The linearisation there, exact, with the dead time.
    StateSpace linearised(const SteadyState& state) const;

    /// The plant with its operating point at a steady state (and its parameter there).
    NonlinearPlant plant_at(const SteadyState& state) const;

    const EquationsRange& range() const { return range_; }
    /// The equations; along a parameter with one more state, the last, that stands for it and whose rate is 0.
    const NonlinearSystem& system() const { return *system_; }
    /// "CA", "Tj", ...: of the scheduling variable.
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
