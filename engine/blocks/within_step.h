// Delayed signals whose dead time is shorter than the step: within it they leave again, so that their values at its end
// depend on themselves, linearly.
//
//   e = A e + b,  e: values, then slopes, at the end of the step;  b: what they were if they ended at 0
//
// Each is a parabola with its value at the start and value and slope at the end of the step, read a dead time before
// its end: without dead time the method is Radau's of third order, which damps what is faster than the step (Hairer and
// Wanner 1996, IV.5). A cubic with both slopes keeps such parts alive.
#pragma once

#include <Eigen/LU>
#include <functional>
#include <vector>

#include "engine/blocks/diagram_system.h"
#include "engine/numerics/cubic.h"

namespace tunewright {

class WithinStep {
public:
    /// `after`: the states after a step of length h, of the input of ManyInputsStep::all and without constant;
    /// `to_node`: from states, delayed signals and their slopes to all signals and their slopes.
    WithinStep(const DiagramSystem& system, double h,
               const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& after, const Eigen::MatrixXd& to_node,
               double slack);

    const std::vector<std::size_t>& signals() const { return signals_; }
    bool empty() const { return signals_.empty(); }
    /// False: e is not determined. A shorter step is needed.
    bool solvable() const { return solvable_; }
    /// b, of the signals' values now and, with e = 0, at the end.
    Signal left(std::size_t which, double now, Signal end) const;
    /// e of b.
    Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return of_left_.solve(b); }

private:
    double h_;
    std::vector<std::size_t> signals_;
    std::vector<double> until_;                     ///< in the step, of each: its length less the dead time
    Eigen::PartialPivLU<Eigen::MatrixXd> of_left_;  ///< I - A
    bool solvable_ = true;
};

/// The parabola of a step of length h.
inline Cubic parabola(double h, double start, Signal end) {
    const double mean_slope = (end.value - start) / h;
    return {start, 2 * mean_slope - end.slope, 2 * (end.slope - mean_slope) / h, 0};
}

}  // namespace tunewright
