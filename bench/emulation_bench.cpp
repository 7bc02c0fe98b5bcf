// The two levels of the method emulation on the stirred tank of Mhaskar, El-Farra and Christofides (2004).
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

/// The whole method, both levels; skipped with an error where Kp is not the reference's.
void whole_method(benchmark::State& state, const char* output, const MethodOptions& options, double Kp) {
    const NonlinearSystem system = NonlinearSystem::make(cstr(output)).value();
    const Plant linear = system.linearised();
    TuningProblem problem{linear, LinearPlant::make(linear).value(), std::nullopt, std::nullopt};
    problem.nonlinear = &system;
    for (auto _ : state) {
        const auto answer = find_method("emulation")->tune(problem, options, {});
        if (!answer || std::abs(answer->controller.Kp / Kp - 1) > 2e-3) state.SkipWithError("not the reference's Kp");
        benchmark::DoNotOptimize(answer);
    }
}

void bound(MethodOptions& options, const std::string& name, double low, double high) {
    options.set("bounds/" + name + "/0", low);
    options.set("bounds/" + name + "/1", high);
}

MethodOptions of_T(const char* formulation) {
    MethodOptions options;
    options.set("controller", std::string("PI"));
    options.set("formulation", std::string(formulation));
    options.set("target/gamma", 0.25);
    options.set("scenarios/0/setpoint_step", 10.0);
    options.set("horizon", 2.0);
    options.set("weights/wy", 0.0);
    bound(options, "Kp", 0.1, 15);
    bound(options, "Ti", 0.05, 3);
    return options;
}

MethodOptions of_CA() {
    MethodOptions options;
    options.set("target/tau_cl", 0.2);
    options.set("target/xi", 1.05);
    options.set("Tf", 0.1);
    options.set("scenarios/0/setpoint_step", 0.05);
    options.set("scenarios/1/setpoint_step", 0.1);
    options.set("scenarios/2/setpoint_step", -0.05);
    options.set("horizon", 2.0);
    options.set("weights/wy", 1e8);
    bound(options, "Kp", -2000, -500);
    bound(options, "Ti", 0.1, 2);
    bound(options, "Td", 0.02, 0.15);
    return options;
}

void full_PI(benchmark::State& state) { whole_method(state, "T", of_T("full"), 4.789863759190389); }
BENCHMARK(full_PI)->Unit(benchmark::kMillisecond);

void remark6_PI(benchmark::State& state) { whole_method(state, "T", of_T("remark6"), 5.395597579096719); }
BENCHMARK(remark6_PI)->Unit(benchmark::kMillisecond);

void full_PID_of_three_scenarios(benchmark::State& state) { whole_method(state, "CA", of_CA(), -1044.503862); }
BENCHMARK(full_PID_of_three_scenarios)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tunewright

BENCHMARK_MAIN();
