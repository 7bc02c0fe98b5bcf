// The steps of a run with the nonlinear PID, whose integral acts on phi(e): the addition to e is one more cubic
// (linear_response.h).
#pragma once

#include <optional>
#include <vector>

#include "engine/simulation/linear/delayed_signal.h"
#include "engine/simulation/linear/long_step.h"
#include "engine/simulation/linear/run_setup.h"
#include "engine/simulation/linear/step_levels.h"

namespace tunewright {

class ScaledSteps {
public:
    /// `setup` and `nodes` must outlive this; the system must have an integral's state. `beyond`: |y| above which a
    /// response counts as unbounded.
    ScaledSteps(const RunSetup& setup, const ErrorScaling& scaling, double beyond, std::vector<ResponseNode>& nodes);

    /// Adds the first node.
    void begin();
    /// Takes a step of this level from t and adds the node at its end. False: the step is too long for the scaled
    /// integral, and nothing has changed. `largest_y`: largest deviation from rest so far.
    bool take(int level, double t, double largest_y);
    /// Prepares steps of another length, up to a horizon.
    void prepare_last(double h) { last_ = propagator_.step(h); }
    void take_last(double t, double end, double largest_y);
    /// At t the delayed signal may jump, and with it u.
    void add_jump(double t);

    /// The integral of the integral's input, which near the end equals the error.
    double error_integral() const { return x_[integral_]; }
    std::shared_ptr<Propagator> propagator() const { return nullptr; }
    bool escaped() const { return !(std::abs(nodes_.back().y) <= beyond_); }
    /// Fit of the last two steps' cubics of phi(e) - e, relative to the local control error, at least `floor`.
    Misfit fit(double floor) const;
    /// The integral so far plus the remaining change of the integral's state.
    std::optional<double> final_integral(std::optional<double> exact) const;

private:
    std::vector<double> input() const;
    void add(const ResponseNode& node);
    void scale(ResponseNode& node);
    void take_short(const ExactStep& step, double t, double end);
    bool take_long(const LongStep& step, double t, double largest_y);
    bool take_closed(const ExactStep& step, double end, bool shortest, double largest_y);
    template <class TryEnd>
    bool settle(double h, bool shortest, double largest_y, const TryEnd& try_end);

    const ResponseSystem& system_;
    ErrorScaling scaling_;
    std::vector<ResponseNode>& nodes_;
    int level_of_L_;
    std::size_t integral_;  // its state
    double into_u_, into_y_, beyond_;
    DelayedSignal delayed_;
    Propagator propagator_;
    LongSteps long_steps_;
    LongStep::Start start_;
    std::vector<double> x_, end_x_;
    Signal excess_;                 // phi(e) - e at the last node
    std::vector<Signal> excesses_;  // of each node
    std::optional<ExactStep> last_;
};

}  // namespace tunewright
