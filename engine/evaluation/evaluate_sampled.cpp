#include "engine/evaluation/evaluate_sampled.h"

#include <algorithm>
#include <cmath>

#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/evaluation/response_pair.h"
#include "engine/evaluation/robustness_figures.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright {

bool comes_to_rest(const ProgramLimits& limits) {
    return limits.u_resolution == 0 && limits.y_resolution == 0 && limits.dead_band == 0;
}

namespace {

using Simulate = std::function<StepResponse(const ProgramLimits&, const StepInputs&, std::optional<double> horizon)>;

KnownResponse run_of(StepResponse response, const ProgramLimits& limits) {
    KnownResponse run = KnownResponse::of(std::move(response));
    if (!comes_to_rest(limits)) run.known_to = run.response.nodes.back().t;
    return run;
}

StepResponse respond(const Simulate& simulate, const ProgramLimits& limits, const StepInputs& inputs,
                     const EvaluateOptions& options) {
    std::optional<double> horizon = options.horizon;
    if (comes_to_rest(limits) || horizon) return simulate(limits, inputs, horizon);
    const StepResponse without = simulate({limits.output, 0, 0, 0}, inputs, horizon);
    return simulate(limits, inputs, without.nodes.back().t);
}

void add_performance(DeviceLoop& on_device, const Simulate& simulate, const ProgramLimits& limits,
                     const EvaluateOptions& options) {
    StepResponse setpoint = respond(simulate, limits, {options.setpoint_step, 0}, options),
                 load = respond(simulate, limits, {0, options.load_step}, options);
    const bool to_infinity = !options.horizon && comes_to_rest(limits);
    on_device.performance.setpoint = setpoint_figures(setpoint, options.setpoint_step, to_infinity);
    on_device.performance.load = load_figures(load, to_infinity);
    on_device.responses = drawn(run_of(std::move(setpoint), limits), run_of(std::move(load), limits), options);
}

}  // namespace

Expected<DeviceLoop> evaluate_sampled(const AnalysedPlant& subject, const SampledPid& law, const ProgramLimits& limits,
                                      const EvaluateOptions& options) {
    const LinearPlant* linear = subject.linear();
    if (linear == nullptr)
        return Error{ErrorKind::unsupported, "implement",
                     "An implemented loop needs a model of the plant, because points of a frequency response do not "
                     "give the response above half the sampling frequency. Identify a model first."};
    if (const auto error = refuse_sampling(*linear, law.Ts, law.computation_delay)) return *error;
    DeviceLoop on_device;
    const SampledLoop loop(*linear, law);
    const LoopGrid grid = make_peak_grid(loop);
    const StabilityCount count = count_unstable_poles(loop, grid);
    if (!count.stable()) {
        on_device.robustness = unstable_robustness(count);
        on_device.performance = no_performance("The implemented loop is unstable.");
        return on_device;
    }
    on_device.robustness = robustness_of(loop, grid);
    if (subject.family() != nullptr) on_device.region = region_figures(*subject.family(), law);
    if (auto error = stopped(options)) return *error;
    const NonlinearSystem* system = subject.equations();
    ProgramLimits all = limits;
    const EvaluateOptions limited = system != nullptr ? limited_as(*system, options) : options;
    if (limited.actuator) all.output = limited.actuator;
    const Simulate simulate = [&](const ProgramLimits& program, const StepInputs& inputs,
                                  std::optional<double> horizon) {
        const SampledOptions run{.horizon = horizon, .stop = options.stop};
        if (system != nullptr) return simulate_sampled(*system, law, program, inputs, run);
        return simulate_sampled(*linear, law, program, inputs, run);
    };
    add_performance(on_device, simulate, all, options);
    if (auto error = stopped(options)) return *error;
    return on_device;
}

}  // namespace tunewright
