#include "engine/identification/fit/response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/identification/fit/unit_systems.h"

namespace tunewright {
namespace {

/// True if the times from index i on are unit_systems::kMarch more steps of dt.
bool evenly(std::span<const double> times, std::size_t i, double dt) {
    using unit_systems::kSameStep;
    const double* t = times.data() + i;
    const Pair first = load(t) - load(t - 1), second = load(t + 2) - load(t + 1);
    return !any((size(first - dt) > kSameStep) | (size(second - dt) > kSameStep));
}

template <int kDerivatives, std::size_t kOrder, class Transition>
void run(std::span<const double> times, const InputSteps& input, double L,
         const unit_systems::DrivenSystem<kOrder, Transition>& system, UnitResponse& out) {
    using namespace unit_systems;
    const std::array<double*, 3> to = {out.x.data(), out.x1.data(), out.x2.data()};
    const auto event_of = [&](std::size_t j) {
        return j < input.time.size() ? input.time[j] + L : std::numeric_limits<double>::infinity();
    };
    DrivenState<kOrder> state(system.readings);
    Steps<kOrder, Transition> steps(system.transition);
    March<kOrder> march;
    double now = 0, event = event_of(0), usual = -1;
    for (std::size_t i = 0, j = 0; i < times.size();) {
        for (; event <= times[i]; event = event_of(++j)) {
            if (event > now) state.advance(event - now, steps.over(event - now));
            now = event;
            state.enter(input.level[j]);
        }
        if (times[i] > now) state.advance(times[i] - now, steps.over(times[i] - now));
        now = times[i];
        state.template read<kDerivatives>(to, i++);
        if (i + kMarch > times.size()) continue;
        const double dt = times[i] - now, before = std::exchange(usual, dt);
        if (std::abs(dt - before) > kSameStep) continue;
        for (; i + kMarch <= times.size() && times[i + kMarch - 1] < event && evenly(times, i, dt); i += kMarch) {
            if (std::abs(dt - march.dt) > kSameStep) march.prepare(dt, steps.over(dt), system.readings);
            state.template march<kDerivatives>(march, times[i + kMarch - 1] - times[i - 1], to, i);
        }
        now = times[i - 1];
    }
}

template <int kDerivatives>
void run(std::span<const double> t, const InputSteps& input, const ModelShape& shape, UnitResponse& out) {
    using namespace unit_systems;
    const auto of = [&](const auto& system) { run<kDerivatives>(t, input, shape.L(), system, out); };
    switch (shape.structure) {
        case Structure::fopdt: return of(lag(shape.T()));
        case Structure::unstable: return of(lag(-shape.T()));
        case Structure::ipdt: return of(integrator());
        case Structure::ipdt_lag: return of(lagged_integrator(shape.T()));
        case Structure::sopdt:
        case Structure::sopdt_zero: return of(second_order(shape.a1(), shape.a2()));
        case Structure::third: return of(third_order(shape.T3(), shape.a1(), shape.a2()));
        case Structure::ipdt_second: return of(integrated_second_order(shape.a1(), shape.a2()));
    }
}

}  // namespace

double ModelShape::T() const { return std::exp(p[1]); }
double ModelShape::a1() const { return std::exp(p[1]); }
double ModelShape::a2() const { return std::exp(2 * p[1] + p[2]); }

double ModelShape::T3() const { return std::exp(p[kThirdLag]); }

double ModelShape::slowest_lag() const {
    if (!has_quadratic(structure)) return T();
    const double ratio = a2() / (a1() * a1());
    const double of_two = ratio < 0.25 ? 0.5 * a1() * (1 + std::sqrt(1 - 4 * ratio)) : std::sqrt(a2());
    return structure == Structure::third ? std::max(of_two, T3()) : of_two;
}

std::vector<int> shape_places(Structure structure) {
    switch (structure) {
        case Structure::ipdt: return {0};
        case Structure::fopdt:
        case Structure::unstable:
        case Structure::ipdt_lag: return {0, 1};
        case Structure::sopdt:
        case Structure::sopdt_zero:
        case Structure::ipdt_second: return {0, 1, 2};
        case Structure::third: return {0, 1, 2, kThirdLag};
    }
    return {};
}

ModelShape further_shape(const ModelShape& shape, int k) {
    ModelShape further;
    further.structure = is_integrating(shape.structure) ? Structure::ipdt_lag : Structure::fopdt;
    further.p[0] = shape.p[further_dead_time(k)];
    further.p[1] = shape.p[further_lag(k)];
    return further;
}

int shape_size(Structure structure) { return static_cast<int>(shape_places(structure).size()); }

bool is_integrating(Structure structure) {
    return structure == Structure::ipdt || structure == Structure::ipdt_lag || structure == Structure::ipdt_second;
}

bool has_quadratic(Structure structure) {
    return structure == Structure::sopdt || structure == Structure::sopdt_zero || structure == Structure::third ||
           structure == Structure::ipdt_second;
}

const char* name_of(Structure structure) {
    switch (structure) {
        case Structure::fopdt: return "fopdt";
        case Structure::unstable: return "unstable fopdt";
        case Structure::sopdt: return "sopdt";
        case Structure::sopdt_zero: return "sopdt_zero";
        case Structure::ipdt: return "ipdt";
        case Structure::ipdt_lag: return "ipdt_lag";
        case Structure::third: return "third order";
        case Structure::ipdt_second: return "ipdt with two lags";
    }
    return "";
}

std::complex<double> unit_transfer(const ModelShape& shape, std::complex<double> s) {
    const std::complex<double> delay = std::exp(-shape.L() * s);
    switch (shape.structure) {
        case Structure::fopdt: return delay / (1.0 + shape.T() * s);
        case Structure::unstable: return delay / (1.0 - shape.T() * s);
        case Structure::ipdt: return delay / s;
        case Structure::ipdt_lag: return delay / (s * (1.0 + shape.T() * s));
        case Structure::sopdt:
        case Structure::sopdt_zero: return delay / (1.0 + s * (shape.a1() + s * shape.a2()));
        case Structure::third: return delay / ((1.0 + s * shape.T3()) * (1.0 + s * (shape.a1() + s * shape.a2())));
        case Structure::ipdt_second: return delay / (s * (1.0 + s * (shape.a1() + s * shape.a2())));
    }
    return 0;
}

void unit_response(std::span<const double> t, const InputSteps& input, const ModelShape& shape, int derivatives,
                   UnitResponse& response) {
    response.x.resize(t.size());
    if (derivatives > 0) response.x1.resize(t.size());
    if (derivatives > 1) response.x2.resize(t.size());
    if (derivatives == 0) return run<0>(t, input, shape, response);
    if (derivatives == 1) return run<1>(t, input, shape, response);
    return run<2>(t, input, shape, response);
}

}  // namespace tunewright
