#include "engine/simulation/sampled/sampled_response.h"

#include <cmath>
#include <deque>

#include "engine/simulation/linear/response_recorder.h"
#include "engine/simulation/nonlinear/nonlinear_loop.h"
#include "engine/simulation/nonlinear/plant_run.h"
#include "engine/simulation/run/loop_sizes.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

constexpr double kTolerance = 1e-8;  // of the integrator's steps
constexpr double kBend = 1e-9;       // of the largest |y|: by so much a jump of its slope would move y over a step
constexpr double kAtOnce = 1e-12;    // relative: times nearer than that are one
constexpr int kFewSamples = 3;       // the least that a response must have rested for, beyond its dead time

struct Given {
    double t = 0, u = 0;
};

class NonlinearRun {
public:
    NonlinearRun(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                 const StepInputs& inputs, const SampledOptions& options)
        : law_(law),
          in_(inputs),
          options_(options),
          output_(limits.output),
          program_(law, limits),
          plant_(system, kTolerance),
          recorder_(response_, recording_, inputs.r),
          rule_(options.settled, system.dead_time() + law.computation_delay + kFewSamples * law.Ts),
          least_size_u_(loop_sizes(size_of_effect(system, 1), law.gains, inputs).u) {}

    StepResponse result();

private:
    bool run_to(double t);
    bool advance(double t);
    bool slope_jumped(const StepPolynomial& y) const;
    bool at_limit() const { return output_ && (u_ <= output_->min || u_ >= output_->max); }
    void note(double t);

    const SampledPid law_;
    const StepInputs in_;
    const SampledOptions options_;
    const std::optional<ActuatorLimits> output_;
    PidProgram program_;
    PlantRun plant_;
    NonlinearResponse response_;
    NonlinearOptions recording_;
    ResponseRecorder recorder_;
    StoppingRule rule_;
    std::deque<Given> outputs_;         // computed, not given out yet
    double u_ = 0;                      // given out
    double y_quiet_ = 0, u_quiet_ = 0;  // near which y and u have stayed since they last moved
    double size_y_ = 0, size_u_ = 0;
    double least_size_u_;  // of the loop, whatever the first samples are
};

// What arrives behind the dead time bends y at once where the plant's relative degree is one.
bool NonlinearRun::slope_jumped(const StepPolynomial& y) const {
    const auto& nodes = response_.loop.nodes;
    return !nodes.empty() && std::abs(y.slope(0) - nodes.back().y_slope) * y.h > kBend * size_y_;
}

bool NonlinearRun::advance(double t) {
    const double short_of = kAtOnce * std::max(t, law_.Ts);
    while (plant_.t() < t - short_of) {
        if (!plant_.step(t)) return false;
        const StepPolynomial& y = plant_.last();
        if (slope_jumped(y)) recorder_.border();
        recorder_.add(y, StepPolynomial::constant(y.t, y.h, u_));
    }
    return true;
}

bool NonlinearRun::run_to(double t) {
    while (!outputs_.empty() && outputs_.front().t < t) {
        const Given next = outputs_.front();
        outputs_.pop_front();
        if (!advance(next.t)) return false;
        if (next.u != u_) recorder_.border();
        u_ = next.u;
        plant_.give(u_ + in_.d);
    }
    return advance(t);
}

// With integral action y comes to rest at r; without it, and at a limit, where it stays.
void NonlinearRun::note(double t) {
    const double y = plant_.y();
    size_y_ = std::max({size_y_, std::abs(y), std::abs(in_.r)});
    size_u_ = std::max({size_u_, std::abs(u_), std::abs(in_.d)});
    const double moved = std::abs(y - y_quiet_), moved_u = std::abs(u_ - u_quiet_);
    const bool to_r = law_.gains.Ki != 0 && !at_limit();
    rule_.note(t, to_r ? std::abs(y - in_.r) : moved, size_y_, moved_u, size_u_);
    if (moved > options_.settled * size_y_ || moved_u > options_.settled * size_u_) {
        y_quiet_ = y;
        u_quiet_ = u_;
    }
}

StepResponse NonlinearRun::result() {
    StepResponse& loop = response_.loop;
    loop.settles = false;
    if (in_.d != 0) plant_.give(in_.d);
    for (int k = 0; k < options_.most_samples && !options_.stop.stop_requested(); ++k) {
        double t = (k + 1) * law_.Ts;
        if (options_.horizon && t >= *options_.horizon - kAtOnce * t) t = *options_.horizon;
        outputs_.push_back({k * law_.Ts + law_.computation_delay, program_.step(in_.r, plant_.y())});
        if (!run_to(t)) break;
        note(t);
        if (k < kFewSamples) least_size_u_ = std::max(least_size_u_, size_u_);
        if (!(size_u_ <= kEscaped * least_size_u_)) break;
        loop.settles = options_.horizon ? t >= *options_.horizon : rule_.has_settled(t);
        if (loop.settles) break;
    }
    const bool at_r = law_.gains.Ki != 0 && loop.settles && !at_limit();
    loop.y_final = at_r ? in_.r : plant_.y();
    loop.u_final = u_;
    if (loop.nodes.empty()) loop.nodes.push_back({});
    if (at_r) loop.error_integral_final = loop.nodes.back().error_integral;
    return std::move(loop);
}

}  // namespace

StepResponse simulate_sampled(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options) {
    return NonlinearRun(system, law, limits, inputs, options).result();
}

}  // namespace tunewright
