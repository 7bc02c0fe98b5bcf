// The steps of a run whose controller is linear: each is one map of the states (step_map.h).
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "engine/simulation/linear/delayed_signal.h"
#include "engine/simulation/linear/long_step.h"
#include "engine/simulation/linear/run_setup.h"
#include "engine/simulation/linear/step_levels.h"
#include "engine/simulation/linear/step_map.h"

namespace tunewright {

/// The maps of steps of length h0 2^level, each made at the first request.
class StepMaps {
public:
    /// `setup` must outlive this. `known`: propagator of another run with the same equations of the states; or null.
    StepMaps(const RunSetup& setup, const std::shared_ptr<Propagator>& known);

    const StepMap& level(int level);
    /// A step that is longer than the dead time.
    const LongStep& long_step(int level) { return long_steps_.level(level, *propagator_); }
    const std::shared_ptr<Propagator>& propagator() const { return propagator_; }
    StepMap of_length(double h) const { return {*system_, propagator_->step(h)}; }

private:
    const StepMap& long_map(int level);

    const ResponseSystem* system_;
    int level_of_L_;
    std::shared_ptr<Propagator> propagator_;
    std::deque<StepMap> maps_;  // of levels 0, 1, ..., up to the dead time
    LongSteps long_steps_;
    std::deque<StepMap> long_maps_;  // of level_of_L + 1, ...
};

class MappedSteps {
public:
    /// `setup` and `nodes` must outlive this.
    MappedSteps(const RunSetup& setup, const std::shared_ptr<Propagator>& known, std::vector<ResponseNode>& nodes);

    /// Adds the first node.
    void begin();
    /// Takes a step of this level from t and adds the node at its end. Returns true, because such a step is always
    /// possible.
    bool take(int level, double t, double largest_y);
    /// Prepares steps of another length, up to a horizon.
    void prepare_last(double h) { last_ = maps_.of_length(h); }
    void take_last(double t, double end, double largest_y);
    /// At t the delayed signal may jump, and with it u.
    void add_jump(double t);

    double error_integral() const { return nodes_.back().error_integral; }
    std::shared_ptr<Propagator> propagator() const { return maps_.propagator(); }
    bool escaped() const { return false; }
    Misfit fit(double) const { return {}; }
    std::optional<double> final_integral(std::optional<double> exact) const { return exact; }

private:
    void take_mapped(const StepMap& map, double t, double end, bool longer);
    void take_unmapped(const LongStep& step, double t);

    const RunSetup& setup_;
    const ResponseSystem& system_;
    std::vector<ResponseNode>& nodes_;
    DelayedSignal delayed_;
    StepMaps maps_;
    RunState state_;
    LongStep::Start start_;
    std::vector<double> x_;
    std::optional<StepMap> last_;
};

}  // namespace tunewright
