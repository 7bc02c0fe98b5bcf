// Plants of every kind, each with independently typed coefficients, and laws that stabilise them.
#pragma once

#include <optional>
#include <string>

#include "engine/plant/plant.h"
#include "tests/engine/loop/sampled_brute_force.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright::test {

struct KnownPlant {
    std::string name;
    Plant plant;  ///< its dead time is set for each case
    Coefficients num, den;
    bool integrating = false;
};

inline Coefficients lags(const std::vector<double>& times_of) {
    Coefficients den{1};
    for (const double T : times_of) den = times(den, {T, 1});
    return den;
}

/// Their time scales are about one.
inline std::vector<KnownPlant> known_plants() {
    using Roots = std::vector<std::complex<double>>;
    std::vector<KnownPlant> all;
    const auto zpk = [&](const std::string& name, double K, const Roots& zeros, const Roots& poles, bool integrating) {
        all.push_back({name, Zpk{.K = K, .zeros = zeros, .poles = poles}, with_roots(zeros, K), with_roots(poles, 1),
                       integrating});
    };
    const auto tf = [&](const std::string& name, const Coefficients& num, const Coefficients& den, bool integrating) {
        all.push_back({name, TransferFunction{.num = num, .den = den}, num, den, integrating});
    };
    for (const double K : {1.0, -2.5})
        all.push_back({"FOPDT, K = " + std::to_string(K), Fopdt{.K = K, .T = 1}, {K}, {1, 1}});
    all.push_back({"fast lag", Fopdt{.K = 1, .T = 0.05}, {1}, {0.05, 1}});
    all.push_back({"SOPDT", Sopdt{.K = 2, .T1 = 1, .T2 = 0.6}, {2}, lags({1, 0.6})});
    all.push_back({"SOPDT, equal", Sopdt{.K = 1, .T1 = 0.7, .T2 = 0.7}, {1}, lags({0.7, 0.7})});
    all.push_back({"SOPDT, far apart", Sopdt{.K = 1, .T1 = 1, .T2 = 0.01}, {1}, lags({1, 0.01})});
    for (const double zeta : {0.05, 0.3, 0.7})
        all.push_back({"oscillating " + std::to_string(zeta),
                       OscillatorySopdt{.K = 1, .T = 0.5, .zeta = zeta},
                       {1},
                       {0.25, zeta, 1}});
    all.push_back({"integrator", Ipdt{.K = 0.8}, {0.8}, {1, 0}, true});
    all.push_back({"integrator and lag", Ipdt{.K = -1.5, .T = 0.4}, {-1.5}, {0.4, 1, 0}, true});
    tf("double integrator", {1}, {1, 0, 0}, true);
    tf("double integrator and lag", {1}, {0.1, 1, 0, 0}, true);
    tf("integrator and resonance", {1}, times({1, 0}, {0.04, 0.04, 1}), true);
    all.push_back({"unstable", Fopdt{.K = 1, .T = -1}, {1}, {-1, 1}});
    zpk("unstable and lag", 2, {}, {0.7, -3.0}, false);
    zpk("unstable pair", 3, {}, {{0.2, 1}, {0.2, -1}}, false);
    zpk("unstable, integrating", 2, {}, {0.3, 0.0, -4.0}, true);
    tf("non-minimum phase", {-0.4, 1}, lags({1, 0.5}), false);
    tf("far zero to the right", {-2, 1}, lags({1, 1, 0.3}), false);
    tf("overshoot zero", {3, 1}, lags({1, 0.5}), false);
    tf("complex zeros", {0.3, 0.1, 1}, lags({1, 0.5, 0.2}), false);
    tf("direct term", {0.3, 1}, {1, 1}, false);
    tf("direct term alone but for a lag", {-0.2, 1}, {0.6, 1}, false);
    tf("direct term and resonance", {0.2, 0.3, 1}, {0.5, 0.2, 1}, false);
    tf("third order", {1}, lags({1, 1, 1}), false);
    tf("fourth order", {1}, lags({1, 0.5, 0.25, 0.125}), false);
    tf("eighth order", {1}, lags({0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3}), false);
    zpk("two resonances", 40, {}, {{-0.2, 2}, {-0.2, -2}, {-0.3, 5}, {-0.3, -5}, -1.0}, false);
    all.push_back({"gain alone", Fopdt{.K = 0.7, .T = 0}, {0.7}, {1}});
    tf("slow tail", {0.9, 1}, lags({1, 5}), false);
    all.push_back({"state space",
                   StateSpace{.A = {{-1, 0.5}, {-0.5, -2}}, .B = {1, 0.2}, .C = {0.3, 1}},
                   {0.5, 0.33},
                   {1, 3, 2.25}});
    return all;
}

inline Plant with_dead_time(Plant plant, double L) {
    std::visit([&](auto& p) { p.L = L; }, plant);
    return plant;
}

constexpr long kParts = 400;

struct SampledCase {
    std::string name;
    Plant plant;
    OwnPlant own;
    double dead_time = 0;
    bool integrating = false;
    SampledPid law;
    PulseResponse pulse;
};

/// A law drawn at random with given rules that holds the loop stable and not too close to the limit; empty if none is
/// found. `dead_parts` and `delay_parts` in parts of Ts/kParts.
inline std::optional<SampledCase> random_case(const KnownPlant& known, Random& random, double Ts, long dead_parts,
                                              long delay_parts, int integral, int derivative, int filter,
                                              bool proportional = true, int tries = 200) {
    SampledCase found;
    found.dead_time = Ts * static_cast<double>(dead_parts) / kParts;
    found.plant = with_dead_time(known.plant, found.dead_time);
    found.own = OwnPlant(known.num, known.den);
    found.integrating = known.integrating;
    const int delay_samples = static_cast<int>((dead_parts + delay_parts) / kParts);
    for (int i = 0; i < tries; ++i) {
        SampledPid law;
        law.Ts = Ts;
        law.integral = static_cast<IntegralRule>(integral);
        law.derivative = static_cast<DerivativeRule>(derivative);
        law.slope_samples = 1 + random.whole(1, 5);
        law.computation_delay = Ts * static_cast<double>(delay_parts) / kParts;
        ParallelPid& g = law.gains;
        g.Kp = (random.one_in(2) ? 1 : -1) * random.log_uniform(0.05, 10);
        g.Ki = g.Kp / random.log_uniform(0.3, 10);
        g.Kd = random.one_in(4) ? 0 : g.Kp * random.log_uniform(0.02, 2);
        if (!proportional) g.Kp = 0;
        g.b = random.uniform(0, 1.2);
        g.c = random.one_in(2) ? 0 : random.uniform(0, 1);
        g.filter = {static_cast<FilterType>(filter), filter == 0 ? 0.0 : Ts * random.log_uniform(0.55, 5)};
        auto pulse = pulse_response_of(OwnLoop(found.own, found.dead_time, law), 3000, delay_samples);
        if (!pulse) continue;
        const double Ms = largest_over_angles([&](double a) { return std::abs(sum_at(pulse->S, a)); }, 50, 15);
        if (Ms > 6) continue;
        found.law = law;
        found.pulse = std::move(*pulse);
        found.name = known.name + ", Ts " + std::to_string(Ts) + ", L " + std::to_string(found.dead_time) + ", rules " +
                     std::to_string(integral) + ' ' + std::to_string(derivative) + " filter " + std::to_string(filter) +
                     " delay " + std::to_string(law.computation_delay);
        return found;
    }
    return std::nullopt;
}

}  // namespace tunewright::test
