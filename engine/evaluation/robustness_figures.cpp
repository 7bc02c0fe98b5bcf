#include "engine/evaluation/robustness_figures.h"

#include <cmath>
#include <numbers>
#include <string>

#include "engine/number_text.h"

namespace tunewright {
namespace {

/// |L| = 1, |L| real and so on, as the contract names them.
void store_margins(Robustness& r, const Margins& m) {
    const std::string no_gain_crossover = "|L| never crosses 1.";
    r.gain_margin = finite_or(m.gain_margin, "No higher gain loses stability.");
    r.gain_margin_low = m.gain_margin_low > 0 ? Figure(m.gain_margin_low) : no_figure("No lower gain loses stability.");
    r.phase_margin_deg = finite_or(m.phase_margin * 180 / std::numbers::pi, no_gain_crossover);
    r.delay_margin = finite_or(m.delay_margin, "No extra dead time loses stability.");
    r.gain_crossover = r.phase_margin_deg ? Figure(m.gain_crossover) : no_figure(no_gain_crossover);
    const bool crosses = (r.gain_margin || r.gain_margin_low) && std::isfinite(m.phase_crossover);
    r.phase_crossover = crosses ? Figure(m.phase_crossover)
                                : no_figure("L never crosses the negative real axis at a finite frequency.");
    r.tolerates.gain_low = r.gain_margin_low.value_or(0);
    r.tolerates.gain_high = r.gain_margin;
    r.tolerates.extra_dead_time = r.delay_margin;
}

}  // namespace

Robustness robustness_of(const Peaks& peaks, const Margins& margins) {
    Robustness r;
    r.stable = true;
    const std::string unbounded = "The derivative has no filter: |C S| grows without bound with frequency.",
                      at_infinity = "The largest value is the limit at infinite frequency.";
    r.Ms = finite_or(peaks.S.value, unbounded);
    r.Mt = finite_or(peaks.T.value, unbounded);
    r.Mks = finite_or(peaks.CS.value, unbounded);
    r.omega_Ms = finite_or(peaks.S.omega, at_infinity);
    r.omega_Mt = finite_or(peaks.T.omega, at_infinity);
    store_margins(r, margins);
    const bool by_S = peaks.S.value >= peaks.T.value;
    const Peak& largest = by_S ? peaks.S : peaks.T;
    r.binding = std::string(by_S ? "Ms" : "Mt") +
                (std::isfinite(largest.omega) ? " at omega " + text(largest.omega, 3) : " at infinite frequency");
    return r;
}

Robustness unstable_robustness(const StabilityCount& count) {
    Robustness r;
    const std::string reason = count.unstable_poles < 0
                                   ? "The closed loop is unstable: |L| does not fall below 1 at high frequency."
                               : count.on_the_boundary ? "The closed loop is on the boundary of stability."
                                                       : "The closed loop is unstable.";
    for (Figure* figure : {&r.Ms, &r.omega_Ms, &r.Mt, &r.omega_Mt, &r.Mks, &r.gain_margin, &r.gain_margin_low,
                           &r.phase_margin_deg, &r.delay_margin, &r.gain_crossover, &r.phase_crossover})
        figure->why = reason;
    r.tolerates = {r.gain_margin, r.gain_margin, r.delay_margin};
    return r;
}

}  // namespace tunewright
