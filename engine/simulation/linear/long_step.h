// A step that is longer than the dead time.
//
// The input of its last part is the step's own, still unknown output w: a cubic through w at the start and through w,
// w' and w'' at the end, all three from the states there. When the dead time and the plant's lags are short compared
// with the step, an integrating mode is approximated by the Pade fraction of numerator degree 1 and denominator degree
// 3: of order 4 and L-stable (Ehle 1973; Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, section
// IV.4), so modes that are too fast for the step decay. A cubic through w and w' at both ends has the same order, but
// with it such modes do not decay. w' and w'' are computed from the states' derivatives, propagated over the step like
// the states: computed as F x + G v at its end they would be differences of large numbers, whose rounding grows with
// the step's length. The result is a fixed row for the states at the start, computed once.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "engine/numerics/propagator.h"
#include "engine/simulation/linear/response_system.h"
#include "engine/simulation/linear/step_map.h"

namespace tunewright {

class LongStep {
public:
    /// First the dead time, then the rest: exact steps of the system's states. `system` must outlive this.
    LongStep(const ResponseSystem& system, ExactStep over_L, ExactStep rest);
    /// A step of twice the length of another one.
    LongStep(const Propagator& propagator, const LongStep& half);

    double h() const { return h_; }

    /// Value and first two derivatives.
    using Jet = std::array<double, 3>;

    /// The known data at the start of a step, before its output is known.
    struct Start {
        Signal v_end;  ///< the known part of the delayed signal at the end
        Jet w_end{};   ///< the known part of the output
        std::vector<double> x;
    };
    void start(Signal v0, Signal w0, const std::vector<double>& x, Start& start) const;

    /// Writes the states at the step's end into x and returns the delayed signal there. `added` is added to the
    /// controller's output at the end, independently of x.
    Signal finish(const Start& start, const Jet& added, std::vector<double>& x) const;

    /// Both parts as one map (step_map.h), without `added`.
    StepMap map() const;

private:
    struct Effect {
        std::vector<double> x;
        Signal v;
        Jet out{};
    };

    void work_out_rows();
    Cubic cubic(double w0, const Jet& end) const;
    Signal delayed_end(const Cubic& c) const;
    Jet through_cubic(const Cubic& c) const;
    Jet end_of(const Cubic& over_L, const Cubic& known, Signal v0, Signal w0, double constant) const;
    Jet solved(const Jet& known) const;
    double output_of(const double* x) const;
    Signal with_effects(const Jet& w, Signal v, double* x) const;
    Effect effect(const Jet& end) const;
    void invert();

    const ResponseSystem* system_;
    ExactStep over_L_, rest_;
    double h_ = 0;
    // M e^(F h) F and M e^(F h) F^2: contributions of the states at the start to w' and w''.
    std::vector<double> to_slope_, to_curvature_;
    // The same for the inputs: M e^(F (h - L)) and M e^(F h) times the moments of the input, G and the constant.
    std::array<double, 4> rest_moments_{}, over_L_moments_{};
    double rest_G_ = 0, whole_G_ = 0, slope_G_ = 0, whole_b_ = 0, slope_b_ = 0;
    std::array<Effect, 3> effects_;     // of value, slope and curvature at the end, times 1, h and h^2
    std::array<double, 9> solution_{};  // (1 - effects on the output)^-1, row by row
};

/// The long steps of a run by level, of length h0 2^level, each made at the first request.
class LongSteps {
public:
    /// The dead time is h0 2^level_of_L. `system` must outlive this.
    LongSteps(const ResponseSystem& system, int level_of_L) : system_(&system), level_of_L_(level_of_L) {}

    /// `propagator`: that of the run.
    const LongStep& level(int level, Propagator& propagator);

private:
    const ResponseSystem* system_;
    int level_of_L_;
    std::deque<LongStep> steps_;  // steps of level_of_L + 1, ...
};

}  // namespace tunewright
