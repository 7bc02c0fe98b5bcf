// One evaluation as a slider asks for it: margins, both responses, traces of 400 points; and the steps it is made of.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/longest_sample_time.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/request/tune.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {
namespace {

const Plant kPlant = Fopdt{.K = 1.25, .T = 40, .L = 8};
const IdealPid kPid{.Kp = 2.6, .Ti = 16, .Td = 3.4, .filter = {FilterType::measurement_second_order, 0.34}};

void evaluate_fopdt(benchmark::State& state) {
    EvaluateOptions options;
    options.points = static_cast<int>(state.range(0));
    for (auto _ : state) {
        const auto evaluation = evaluate(kPlant, kPid, options);
        if (!evaluation || !evaluation->robustness.stable) state.SkipWithError("no evaluation");
        benchmark::DoNotOptimize(evaluation);
    }
}
BENCHMARK(evaluate_fopdt)->Arg(0)->Arg(400)->Unit(benchmark::kMicrosecond);

void load_response(benchmark::State& state) {
    const auto plant = LinearPlant::make(kPlant);
    for (auto _ : state) benchmark::DoNotOptimize(simulate_linear(*plant, to_parallel(kPid), {0, 1}, {}));
}
BENCHMARK(load_response)->Unit(benchmark::kMicrosecond);

void peaks(benchmark::State& state) {
    const auto plant = LinearPlant::make(kPlant);
    const auto loop = Loop::make(*plant, to_parallel(kPid));
    for (auto _ : state) benchmark::DoNotOptimize(find_peaks(*loop, make_peak_grid(*loop)));
}
BENCHMARK(peaks)->Unit(benchmark::kMicrosecond);

void stability_by_argument(benchmark::State& state) {
    const auto plant = LinearPlant::make(kPlant);
    const auto loop = Loop::make(*plant, to_parallel(kPid));
    for (auto _ : state) benchmark::DoNotOptimize(count_unstable_poles(*loop));
}
BENCHMARK(stability_by_argument)->Unit(benchmark::kMicrosecond);

void rightmost_pole_by_discretisation(benchmark::State& state) {
    const auto plant = LinearPlant::make(kPlant);
    const auto loop = Loop::make(*plant, to_parallel(kPid));
    for (auto _ : state) benchmark::DoNotOptimize(rightmost_pole(*loop));
}
BENCHMARK(rightmost_pole_by_discretisation)->Unit(benchmark::kMicrosecond);

void longest_sample_time_of_a_pid(benchmark::State& state) {
    const auto plant = LinearPlant::make(kPlant);
    const auto loop = Loop::make(*plant, to_parallel(kPid));
    const Peak peak = find_peaks(*loop, make_peak_grid(*loop)).S;
    for (auto _ : state)
        benchmark::DoNotOptimize(longest_sample_time(*plant, to_parallel(kPid), peak.value, peak.omega, 1.05));
}
BENCHMARK(longest_sample_time_of_a_pid)->Unit(benchmark::kMicrosecond);

// The job that a queue of small jobs is made of.
void rule_with_evaluation(benchmark::State& state) {
    TuningRequest request;
    request.subject = std::get<AnalysedPlant>(AnalysedPlant::make(Plant(Fopdt{.K = 1, .T = 40, .L = 2})));
    request.tune = {{.method = "simc", .options = {}}};
    request.evaluate.points = static_cast<int>(state.range(0));
    for (auto _ : state) {
        const auto result = tune(request, {});
        if (!result) return state.SkipWithError(result.error().message.c_str());
        benchmark::DoNotOptimize(result);
    }
}
BENCHMARK(rule_with_evaluation)->Arg(100)->Arg(400)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tunewright

int main(int argc, char** argv) {
    // Memory stays with the process, as it does with the service: else each evaluation pays for fresh pages.
    mallopt(M_TRIM_THRESHOLD, 64 * 1024 * 1024);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
