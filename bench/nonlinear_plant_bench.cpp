// What a nonlinear plant costs: reading its texts, its steady state, one evaluation, its derivatives.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "engine/plant/expression/parser.h"
#include "engine/plant/nonlinear/lie_derivatives.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/simulation/nonlinear/linearising_response.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

NonlinearSystem made(const std::string& output) {
    auto system = NonlinearSystem::make(cstr(output));
    if (!system || std::abs(system->x_steady()[1] - 398.96799958114184) > 1e-9)
        throw std::runtime_error("the reactor's steady state is wrong");
    return *system;
}

void parse_energy_balance(benchmark::State& state) {
    const std::string energy_balance = cstr("T").equations[1].text;
    for (auto _ : state) benchmark::DoNotOptimize(parse_expression(energy_balance));
}
BENCHMARK(parse_energy_balance);

void make_reactor(benchmark::State& state) {
    const NonlinearPlant plant = cstr("T");
    for (auto _ : state) benchmark::DoNotOptimize(NonlinearSystem::make(plant));
}
BENCHMARK(make_reactor);

void rates_and_output(benchmark::State& state) {
    const auto system = made("T");
    std::array<double, 2> x = {0.5, 400}, dx = {};
    for (auto _ : state) {
        benchmark::DoNotOptimize(x);
        system.rates(x, 493.87, dx);
        benchmark::DoNotOptimize(dx[0] + system.output(x));
    }
}
BENCHMARK(rates_and_output);

void jacobian(benchmark::State& state) {
    const auto system = made("T");
    std::array<double, 2> x = {0.5, 400}, B = {};
    std::array<double, 4> A = {};
    for (auto _ : state) {
        benchmark::DoNotOptimize(x);
        benchmark::DoNotOptimize(system.jacobian(x, 493.87, A, B));
    }
}
BENCHMARK(jacobian);

void lie_derivatives_of_order(benchmark::State& state) {
    const int r = static_cast<int>(state.range(0));
    const auto system = made(r == 1 ? "T" : "CA");
    std::array<double, 2> x = {0.5, 400};
    LieDerivatives lie;
    for (auto _ : state) {
        benchmark::DoNotOptimize(x);
        benchmark::DoNotOptimize(lie_derivatives(system, r, x, lie));
    }
}
BENCHMARK(lie_derivatives_of_order)->Arg(1)->Arg(2);

void linearising_loop(benchmark::State& state) {
    const bool first = state.range(0) == 1;
    const auto system = made(first ? "T" : "CA");
    const auto target = first ? first_order_target(0.25) : second_order_target(0.2, 1.05);
    for (auto _ : state)
        benchmark::DoNotOptimize(simulate_linearising(system, target, first ? 10 : 0.14, {.horizon = 2}, {}));
}
BENCHMARK(linearising_loop)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tunewright

BENCHMARK_MAIN();
