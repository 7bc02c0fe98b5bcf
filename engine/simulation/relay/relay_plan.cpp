#include "engine/simulation/relay/relay_plan.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr double kNoiseBand = 3;  // hysteresis per noise_std
constexpr double kSwing = 3;      // amplitude of y per hysteresis
constexpr int kQuietCycles = 3, kNoisyCycles = 10;
constexpr double kRowsPerPeriod = 200;

double amplitude(const SteadyRelayCycle& cycle) { return (cycle.y_max - cycle.y_min) / 2; }

// Scaling levels and hysteresis together scales y: the cycle for levels f u and hysteresis eps is f times that for u
// and eps/f.
std::optional<SteadyRelayCycle> enlarged(const LinearPlant& plant, const RelayLevels& levels, double& factor,
                                         const RunControl& control) {
    std::optional<SteadyRelayCycle> best;
    for (int i = 0; i < 20; ++i) {
        const RelayLevels scaled{levels.u_plus, levels.u_minus, levels.hysteresis / factor};
        auto cycle = steady_relay_cycle(plant, scaled, control);
        if (cycle) {
            const double short_of = kSwing * scaled.hysteresis / amplitude(*cycle);
            best = *cycle;
            if (short_of <= 1) break;
            factor *= std::max(short_of, 1.1);
        } else if (cycle.error().kind == ErrorKind::cancelled) {
            return std::nullopt;
        } else {
            factor *= 2;
        }
    }
    return best;
}

std::string sentence(const RelayPlan& plan, const RelaySettings& settings, int settling, double factor) {
    std::string out;
    if (settings.noise_std > 0) {
        out = "hysteresis is 3 noise_std: a single noisy sample crosses it by chance once in 741. ";
        out += factor > 1 ? "The levels are " + text(factor) + " times those given, so that y swings "
                          : std::string("With the levels given y swings ");
        out += text(plan.amplitude / plan.hysteresis) + " hystereses to either side. ";
    } else {
        out = "Levels and hysteresis as given; tell noise_std for a hysteresis against noise. ";
    }
    out += std::to_string(settling) + (settling == 1 ? " cycle" : " cycles") + " to settle and " +
           std::to_string(plan.cycles - settling) +
           (settings.noise_std > 0 ? " to average: the error falls with the root of their number." : " to measure.");
    return out;
}

}  // namespace

double round_down(double x) {
    const double power = std::pow(10.0, std::floor(std::log10(x)));
    const double first = x / power;
    return power * (first >= 5 ? 5 : first >= 2 ? 2 : 1);
}

RelayPlan plan_relay(const LinearPlant& plant, const RelaySettings& settings, const SteadyRelayCycle& steady,
                     const RunControl& control) {
    const bool noisy = settings.noise_std > 0;
    RelayLevels levels{settings.u_plus, settings.u_minus,
                       noisy ? kNoiseBand * settings.noise_std : settings.hysteresis};
    SteadyRelayCycle cycle = steady;
    double factor = 1;
    if (noisy) {
        if (const auto better = enlarged(plant, levels, factor, control)) {
            cycle = *better;
        } else {
            factor = 1;
            levels.hysteresis = settings.hysteresis;
        }
    }
    RelayPlan plan;
    plan.u_plus = factor * levels.u_plus;
    plan.u_minus = factor * levels.u_minus;
    plan.hysteresis = levels.hysteresis;
    plan.amplitude = factor * amplitude(cycle);
    plan.expected_period = cycle.Pu();
    plan.cycles = std::min(cycle.settling_cycles + (noisy ? kNoisyCycles : kQuietCycles), kMaxRelayCycles);
    plan.duration = plant.dead_time() + plan.cycles * cycle.Pu();
    const double spacing = cycle.Pu() / kRowsPerPeriod, Ts = settings.relay_sample_time;
    plan.record_interval = Ts > 0 ? Ts * std::max(1.0, std::floor(spacing / Ts)) : round_down(spacing);
    plan.reason = sentence(plan, settings, plan.cycles - (noisy ? kNoisyCycles : kQuietCycles), factor);
    return plan;
}

}  // namespace tunewright
