#include "engine/simulation/sampled/sampled_response.h"

#include <cmath>
#include <deque>

#include "engine/simulation/linear/response_recorder.h"
#include "engine/simulation/nonlinear/plant_run.h"
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
          program_(law, limits),
          plant_(system, kTolerance),
          recorder_(response_, recording_, inputs.r),
          rule_(options.settled, system.dead_time() + law.computation_delay + kFewSamples * law.Ts) {}

    StepResponse result();

private:
    bool run_to(double t);
    bool advance(double t);
    bool slope_jumped(const StepPolynomial& y) const;
    void note(double t, double u_before);

    const SampledPid law_;
    const StepInputs in_;
    const SampledOptions options_;
    PidProgram program_;
    PlantRun plant_;
    NonlinearResponse response_;
    NonlinearOptions recording_;
    ResponseRecorder recorder_;
    StoppingRule rule_;
    std::deque<Given> outputs_;  // computed, not given out yet
    double u_ = 0;               // given out
    double y_before_ = 0, size_y_ = 0, size_u_ = 0, first_size_ = 0;
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

// With integral action y comes to rest at r; without it where it stays.
void NonlinearRun::note(double t, double u_before) {
    const double y = plant_.y(), distance = law_.gains.Ki != 0 ? y - in_.r : y - y_before_;
    size_y_ = std::max({size_y_, std::abs(y), std::abs(in_.r)});
    size_u_ = std::max({size_u_, std::abs(u_), std::abs(in_.d)});
    rule_.note(t, std::abs(distance), size_y_, std::abs(u_ - u_before), size_u_);
    y_before_ = y;
}

StepResponse NonlinearRun::result() {
    StepResponse& loop = response_.loop;
    loop.settles = false;
    if (in_.d != 0) plant_.give(in_.d);
    for (int k = 0; k < options_.most_samples; ++k) {
        const double t = (k + 1) * law_.Ts, u_before = u_;
        outputs_.push_back({k * law_.Ts + law_.computation_delay, program_.step(in_.r, plant_.y())});
        if (!run_to(t)) break;
        note(t, u_before);
        if (k < kFewSamples) first_size_ = std::max(size_y_, size_u_);
        if (!(size_u_ <= kEscaped * first_size_)) break;
        loop.settles = options_.horizon ? t >= *options_.horizon : rule_.has_settled(t);
        if (loop.settles) break;
    }
    loop.y_final = law_.gains.Ki != 0 && loop.settles ? in_.r : plant_.y();
    loop.u_final = u_;
    if (loop.nodes.empty()) loop.nodes.push_back({});
    if (loop.settles && law_.gains.Ki != 0) loop.error_integral_final = loop.nodes.back().error_integral;
    return std::move(loop);
}

}  // namespace

StepResponse simulate_sampled(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options) {
    return NonlinearRun(system, law, limits, inputs, options).result();
}

}  // namespace tunewright
