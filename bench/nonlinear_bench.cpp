// Closed loops on a nonlinear plant, and the tests made on it by simulation.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/evaluate.h"
#include "engine/simulation/nonlinear_experiments.h"
#include "engine/simulation/nonlinear_response.h"

namespace tunewright {
namespace {

/// The endothermic CSTR of Mhaskar, El-Farra & Christofides (2004), Eq. 4; minutes.
NonlinearSystem cstr(const char* output, double L = 0) {
    return *NonlinearSystem::make(
        {.states = {{"CA", 0.52}, {"T", 398.97}},
         .parameters = {{"V", 100.0},
                        {"F", 100.0},
                        {"ER", 8000.0},
                        {"CA0", 1.0},
                        {"TA0", 400.0},
                        {"DH", 2e5},
                        {"k0", 4.71e8},
                        {"cp", 1.0},
                        {"rho", 1000.0},
                        {"UA", 1e5}},
         .equations = {{"CA", "F/V*(CA0-CA)-k0*exp(-ER/T)*CA"},
                       {"T", "F/V*(TA0-T)-DH/(rho*cp)*k0*exp(-ER/T)*CA+UA/(rho*cp*V)*(Tj-T)"}},
         .input = {.name = "Tj", .nominal = 493.87},
         .output = output,
         .L = L});
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

void pi_loop_nodes(benchmark::State& state) { loop(state, cstr("T"), kPi, 10, two_minutes(true, 0)); }
BENCHMARK(pi_loop_nodes)->Unit(benchmark::kMicrosecond);

void pi_loop_401_samples(benchmark::State& state) { loop(state, cstr("T"), kPi, 10, two_minutes(false, 401)); }
BENCHMARK(pi_loop_401_samples)->Unit(benchmark::kMicrosecond);

void pid_loop_nodes(benchmark::State& state) { loop(state, cstr("CA"), kPid, 0.05, two_minutes(true, 0)); }
BENCHMARK(pid_loop_nodes)->Unit(benchmark::kMicrosecond);

void pid_loop_401_samples(benchmark::State& state) { loop(state, cstr("CA"), kPid, 0.05, two_minutes(false, 401)); }
BENCHMARK(pid_loop_401_samples)->Unit(benchmark::kMicrosecond);

void pi_loop_dead_time(benchmark::State& state) {
    const ParallelPid slow{.Kp = 4, .Ki = 16};
    loop(state, cstr("T", 0.05), slow, 10, two_minutes(true, 0));
}
BENCHMARK(pi_loop_dead_time)->Unit(benchmark::kMicrosecond);

void pi_loop_limited(benchmark::State& state) {
    NonlinearOptions options = two_minutes(true, 0);
    options.actuator = OutputLimits{-50, 50};
    loop(state, cstr("T"), kPi, 10, options);
}
BENCHMARK(pi_loop_limited)->Unit(benchmark::kMicrosecond);

void evaluation(benchmark::State& state) {
    const auto system = cstr("T");
    EvaluateOptions options;
    options.setpoint_step = 10;
    for (auto _ : state) {
        const auto evaluation = evaluate(system, Pid{.Kp = 4.8, .Ti = 0.194}, options);
        if (!evaluation || !evaluation->performance.load.IAE) state.SkipWithError("no figures");
        benchmark::DoNotOptimize(evaluation);
    }
}
BENCHMARK(evaluation)->Unit(benchmark::kMicrosecond);

void step_test(benchmark::State& state) {
    const auto system = cstr("CA");
    for (auto _ : state) {
        const auto test = simulate_step_test(system, 10, {});
        if (!test || !test->settled) state.SkipWithError("not settled");
        benchmark::DoNotOptimize(test);
    }
}
BENCHMARK(step_test)->Unit(benchmark::kMicrosecond);

void relay_test(benchmark::State& state) {
    const auto system = cstr("T", 0.05);
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
