// What a nonlinear plant costs: reading its texts, its steady state, one evaluation, its derivatives.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "engine/plant/expression/parser.h"
#include "engine/plant/lie_derivatives.h"
#include "engine/plant/nonlinear_system.h"
#include "engine/simulation/linearising_response.h"

namespace tunewright {
namespace {

constexpr const char* kEnergyBalance = "F/V*(TA0-T)-DH/(rho*cp)*k0*exp(-ER/T)*CA+UA/(rho*cp*V)*(Tj-T)";

NonlinearPlant reactor(const std::string& output) {
    return {.states = {{"CA", 0.52}, {"T", 398.97}},
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
            .equations = {{"CA", "F/V*(CA0-CA)-k0*exp(-ER/T)*CA"}, {"T", kEnergyBalance}},
            .input = {.name = "Tj", .nominal = 493.87},
            .output = output};
}

NonlinearSystem made(const std::string& output) {
    auto system = NonlinearSystem::make(reactor(output));
    if (!system || std::abs(system->x_steady()[1] - 398.96799958114184) > 1e-9)
        throw std::runtime_error("the reactor's steady state is wrong");
    return *system;
}

void parse_energy_balance(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(parse_expression(kEnergyBalance));
}
BENCHMARK(parse_energy_balance);

void make_reactor(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(NonlinearSystem::make(reactor("T")));
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
