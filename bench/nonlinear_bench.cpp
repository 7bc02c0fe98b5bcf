// Closed loops on a nonlinear plant, and the tests made on it by simulation.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "engine/simulation/experiment/nonlinear_experiments.h"
#include "engine/simulation/nonlinear/nonlinear_response.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

NonlinearSystem reactor(const char* output, double L = 0) {
    NonlinearPlant plant = cstr(output);
    plant.L = L;
    return NonlinearSystem::make(plant).value();
}

const ParallelPid kPi{.Kp = 4.789863759190389, .Ki = 4.789863759190389 / 0.1944095039389805};
const ParallelPid kPid{
    .Kp = -1342.7, .Ki = -1342.7 / 0.95, .Kd = -1342.7 * 0.0524, .filter = {FilterType::derivative, 0.1}};

NonlinearOptions two_minutes(bool nodes, int samples) {
    NonlinearOptions options;
    options.horizon = 2;
    options.nodes = nodes;
    options.samples = samples;
    return options;
}

void loop(benchmark::State& state, const NonlinearSystem& system, const ParallelPid& controller, double r,
          const NonlinearOptions& options) {
    for (auto _ : state) {
        const auto response = simulate_nonlinear(system, controller, {r, 0}, options);
        if (!response.ended.empty() || std::abs(response.loop.y_final / r - 1) > 0.1) state.SkipWithError("wrong end");
        benchmark::DoNotOptimize(response);
    }
}

void pi_loop_nodes(benchmark::State& state) { loop(state, reactor("T"), kPi, 10, two_minutes(true, 0)); }
BENCHMARK(pi_loop_nodes)->Unit(benchmark::kMicrosecond);

void pi_loop_401_samples(benchmark::State& state) { loop(state, reactor("T"), kPi, 10, two_minutes(false, 401)); }
BENCHMARK(pi_loop_401_samples)->Unit(benchmark::kMicrosecond);

void pid_loop_nodes(benchmark::State& state) { loop(state, reactor("CA"), kPid, 0.05, two_minutes(true, 0)); }
BENCHMARK(pid_loop_nodes)->Unit(benchmark::kMicrosecond);

void pid_loop_401_samples(benchmark::State& state) { loop(state, reactor("CA"), kPid, 0.05, two_minutes(false, 401)); }
BENCHMARK(pid_loop_401_samples)->Unit(benchmark::kMicrosecond);

void pi_loop_dead_time(benchmark::State& state) {
    const ParallelPid slow{.Kp = 4, .Ki = 16};
    loop(state, reactor("T", 0.05), slow, 10, two_minutes(true, 0));
}
BENCHMARK(pi_loop_dead_time)->Unit(benchmark::kMicrosecond);

void pi_loop_limited(benchmark::State& state) {
    NonlinearOptions options = two_minutes(true, 0);
    options.actuator = ActuatorLimits{-50, 50};
    loop(state, reactor("T"), kPi, 10, options);
}
BENCHMARK(pi_loop_limited)->Unit(benchmark::kMicrosecond);

void evaluation(benchmark::State& state) {
    const auto system = reactor("T");
    const AnalysedNonlinear subject{system, *linearised_plant(system)};
    EvaluateOptions options;
    options.setpoint_step = 10;
    for (auto _ : state) {
        const auto evaluation = evaluate_nonlinear(subject, IdealPid{.Kp = 4.8, .Ti = 0.194}, options);
        if (!evaluation || !evaluation->performance.load.IAE) state.SkipWithError("no figures");
        benchmark::DoNotOptimize(evaluation);
    }
}
BENCHMARK(evaluation)->Unit(benchmark::kMicrosecond);

void step_test(benchmark::State& state) {
    const auto system = reactor("CA");
    for (auto _ : state) {
        const auto test = simulate_step_test(system, 10, {});
        if (!test || !test->settled) state.SkipWithError("not settled");
        benchmark::DoNotOptimize(test);
    }
}
BENCHMARK(step_test)->Unit(benchmark::kMicrosecond);

void relay_test(benchmark::State& state) {
    const auto system = reactor("T", 0.05);
    for (auto _ : state) {
        const auto test = simulate_relay_test(system, 5, 0, {});
        if (!test) state.SkipWithError("no oscillation");
        benchmark::DoNotOptimize(test);
    }
}
BENCHMARK(relay_test)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tunewright

BENCHMARK_MAIN();
