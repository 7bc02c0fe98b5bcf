// Identification of recorded tests: a step and a relay test of usual lengths, and a million samples.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/identification/identify.h"
#include "engine/simulation/relay/relay.h"

namespace tunewright {
namespace {

double normal(std::mt19937_64& bits) {
    const auto uniform = [&] { return (static_cast<double>(bits() >> 11) + 0.5) / 9007199254740992.0; };
    return std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
}

/// e^(-3s) 1.5/(12s + 1), a step after a tenth of the record; five time constants follow it.
Record step_record(int samples, double noise) {
    std::mt19937_64 bits(7);
    Record record;
    const double spacing = 80.0 / samples, start = spacing * std::floor(0.1 * samples);
    for (int i = 0; i < samples; ++i) {
        const double t = spacing * i, after = t - start - 3;
        record.t.push_back(t);
        record.u.push_back(t >= start ? 1 : 0);
        record.y.push_back((after > 0 ? 1.5 * -std::expm1(-after / 12) : 0) + noise * normal(bits));
    }
    return record;
}

/// Ten noisy cycles of e^(-2s)/(10s + 1) under a biased relay, about `rows` rows.
Record relay_record(int rows) {
    RelaySettings settings;
    settings.u_plus = 1.3;
    settings.u_minus = -0.7;
    settings.hysteresis = 0.2;
    settings.noise_std = 0.01;
    settings.relay_sample_time = 150.0 / rows;
    const auto experiment = simulate_relay(Fopdt{.K = 1, .T = 10, .L = 2}, settings, {});
    Record record;
    record.t = experiment->record.t;
    record.u = experiment->record.u;
    record.y = experiment->record.y;
    record.t.resize(std::min<std::size_t>(record.t.size(), static_cast<std::size_t>(rows)));
    record.u.resize(record.t.size());
    record.y.resize(record.t.size());
    return record;
}

void identify_record(benchmark::State& state, const Record& record, const Fopdt& truth) {
    for (auto _ : state) {
        const auto model = identify(record, {}, {});
        const auto* plant = model ? std::get_if<Fopdt>(&model->plant) : nullptr;
        if (plant == nullptr || std::abs(plant->T - truth.T) > 0.05 * truth.T) state.SkipWithError("another model");
        benchmark::DoNotOptimize(model);
    }
    state.counters["samples"] = static_cast<double>(record.t.size());
}

void step(benchmark::State& state) {
    identify_record(state, step_record(static_cast<int>(state.range(0)), 0.02), {1.5, 12, 3});
}
BENCHMARK(step)->Arg(1000)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void relay(benchmark::State& state) {
    identify_record(state, relay_record(static_cast<int>(state.range(0))), {1, 10, 2});
}
BENCHMARK(relay)->Arg(1000)->Arg(10'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tunewright

BENCHMARK_MAIN();
