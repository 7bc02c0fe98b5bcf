// A step that is longer than the dead time.
//
// Its last part sees the step's own, still unknown output w: a cubic through w at the start and through w, w' and w''
// at the end, all three from the states there. Once the dead time and the plant's lags are short beside the step, an
// integrating mode sees the Pade approximant of numerator degree 1 and denominator degree 3: of order 4 and L-stable
// (Ehle 1973; Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, section IV.4), so what is too fast
// for the step dies out. A cubic through w and w' at both ends has the same order but keeps such modes alive.
// w' and w'' come from the states' derivatives, carried over the step like the states: as F x + G v at its end they
// would be differences of large numbers, whose rounding the step's length magnifies. What they come to is a fixed row
// for the states at the start, worked out once.
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
    /// First the dead time, then the rest: exact steps of the system's states. `system` must live as long as this.
    LongStep(const ResponseSystem& system, ExactStep over_L, ExactStep rest);
    /// Twice as long as another one.
    LongStep(const Propagator& propagator, const LongStep& half);

    double h() const { return h_; }

    /// Value and first two derivatives.
    using Jet = std::array<double, 3>;

    /// What a step starts from, before its output is known.
    struct Start {
        Signal v_end;  ///< the delayed signal at the end, as far as it follows from what is known now
        Jet w_end{};   ///< the same of the output
        std::vector<double> x;
    };
    void start(Signal v0, Signal w0, const std::vector<double>& x, Start& start) const;

    /// Puts the states at the step's end into x; gives the delayed signal there. `added` is what the controller's
    /// output gets on top at the end, not from x.
    Signal finish(const Start& start, const Jet& added, std::vector<double>& x) const;

    /// Both as one map (step_map.h), where nothing is added.
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
    // M e^(F h) F and M e^(F h) F^2: what the states at the start leave of w' and w''.
    std::vector<double> to_slope_, to_curvature_;
    // The same for what comes in: M e^(F (h - L)) and M e^(F h) by the moments of the input, by G, by the constant.
    std::array<double, 4> rest_moments_{}, over_L_moments_{};
    double rest_G_ = 0, whole_G_ = 0, slope_G_ = 0, whole_b_ = 0, slope_b_ = 0;
    std::array<Effect, 3> effects_;     // of value, slope and curvature at the end, times 1, h and h^2
    std::array<double, 9> solution_{};  // (1 - effects on the output)^-1, row by row
};

/// Those of a run, by their level: of length h0 2^level, each made when it is asked for.
class LongSteps {
public:
    /// The dead time is h0 2^level_of_L. `system` must live as long as this.
    LongSteps(const ResponseSystem& system, int level_of_L) : system_(&system), level_of_L_(level_of_L) {}

    /// `propagator`: the run's.
    const LongStep& level(int level, Propagator& propagator);

private:
    const ResponseSystem* system_;
    int level_of_L_;
    std::deque<LongStep> steps_;  // of level_of_L + 1, ...
};

}  // namespace tunewright
