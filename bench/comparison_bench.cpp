// The comparison of all methods on a FOPDT plant as a browser asks for it: every method in all its variants, traces of
// 400 points.
#include <benchmark/benchmark.h>

#include <atomic>
#include <thread>

#include "engine/request/tune.h"

namespace tunewright {
namespace {

TuningRequest request_for(double L_over_T) {
    TuningRequest request;
    request.subject =
        std::get<AnalysedPlant>(AnalysedPlant::make(Plant(Fopdt{.K = 1.25, .T = 40, .L = 40 * L_over_T})));
    request.tune = {{.method = "all", .options = {}}};
    return request;
}

/// As a service's worker has it while another core is idle.
void on_two_cores(int n, const std::function<void(int)>& f) {
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int i = next++; i < n; i = next++) f(i);
    };
    const std::jthread other(work);
    work();
}

void run(benchmark::State& state, bool with_optima, const ParallelFor& spread = {}) {
    TuningRequest request = request_for(static_cast<double>(state.range(0)) / 100);
    request.evaluate.optimum_at_Ms = with_optima;
    int rows = 0;
    for (auto _ : state) {
        const auto result = tune(request, {.stop = {}, .progress = {}, .now_ms = {}, .spread = spread});
        if (!result) return state.SkipWithError(result.error().message.c_str());
        rows = static_cast<int>(result->ranking.size());
    }
    state.counters["rows"] = rows;
}

// The argument is 100 L/T.
void comparison(benchmark::State& state) { run(state, false); }
BENCHMARK(comparison)->Arg(10)->Arg(30)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

void comparison_with_optima(benchmark::State& state) { run(state, true); }
BENCHMARK(comparison_with_optima)->Arg(10)->Arg(30)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

void comparison_two_cores(benchmark::State& state) { run(state, false, on_two_cores); }
BENCHMARK(comparison_two_cores)->Arg(10)->Arg(30)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond)->UseRealTime();

void comparison_with_optima_two_cores(benchmark::State& state) { run(state, true, on_two_cores); }
BENCHMARK(comparison_with_optima_two_cores)
    ->Arg(10)
    ->Arg(30)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace tunewright

BENCHMARK_MAIN();
