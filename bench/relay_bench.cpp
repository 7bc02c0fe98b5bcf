// A relay test as the service simulates it: the steady cycle as a fixed point, ten cycles recorded, a plan.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/simulation/relay/relay.h"

namespace tunewright {
namespace {

void relay_test(benchmark::State& state, const Plant& plant, RelaySettings settings, double Pu) {
    for (auto _ : state) {
        const auto experiment = simulate_relay(plant, settings, {});
        if (!experiment || std::abs(experiment->limit_cycle.Pu - Pu) > 1e-6 * Pu) state.SkipWithError("wrong period");
        benchmark::DoNotOptimize(experiment);
    }
}

RelaySettings biased() {
    RelaySettings settings;
    settings.u_plus = 1.3;
    settings.u_minus = -0.7;
    settings.hysteresis = 0.2;
    return settings;
}

void first_order(benchmark::State& state) { relay_test(state, Fopdt{.K = 1, .T = 10, .L = 2}, biased(), 15.56731); }
BENCHMARK(first_order)->Unit(benchmark::kMicrosecond);

void fifth_order(benchmark::State& state) {
    const TransferFunction plant{.num = {-1, 1}, .den = {1, 5, 10, 10, 5, 1}, .L = 1};
    relay_test(state, plant, biased(), 14.3658);
}
BENCHMARK(fifth_order)->Unit(benchmark::kMicrosecond);

void first_order_sampled_with_noise(benchmark::State& state) {
    RelaySettings settings = biased();
    settings.u_plus = 1;
    settings.u_minus = -1;
    settings.noise_std = 0.02;
    settings.relay_sample_time = 0.01;
    relay_test(state, Fopdt{.K = 1, .T = 10, .L = 2}, settings, 14.40);
}
BENCHMARK(first_order_sampled_with_noise)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tunewright

BENCHMARK_MAIN();
