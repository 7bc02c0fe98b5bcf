#include "engine/evaluation/robustness_figures.h"

#include <cmath>
#include <numbers>
#include <sstream>

namespace tunewright {
namespace {

std::string shown(double value) {
    std::ostringstream out;
    out.precision(3);
    out << value;
    return out.str();
}

/// Stores finite values; says why there is none otherwise.
void store(std::optional<double>& field, double value, WhyNull& why, const char* name, const char* reason) {
    if (std::isfinite(value))
        field = value;
    else
        why[name] = reason;
}

/// |L| = 1, |L| real and so on, as the contract names them.
void store_margins(Robustness& r, const Margins& m) {
    store(r.gain_margin, m.gain_margin, r.why_null, "gain_margin", "No higher gain loses stability.");
    if (m.gain_margin_low > 0)
        r.gain_margin_low = m.gain_margin_low;
    else
        r.why_null["gain_margin_low"] = "No lower gain loses stability.";
    store(r.phase_margin_deg, m.phase_margin * 180 / std::numbers::pi, r.why_null, "phase_margin_deg",
          "|L| never crosses 1.");
    store(r.delay_margin, m.delay_margin, r.why_null, "delay_margin", "No extra dead time loses stability.");
    if (std::isfinite(m.phase_margin))
        r.gain_crossover = m.gain_crossover;
    else
        r.why_null["gain_crossover"] = "|L| never crosses 1.";
    if ((std::isfinite(m.gain_margin) || m.gain_margin_low > 0) && std::isfinite(m.phase_crossover))
        r.phase_crossover = m.phase_crossover;
    else
        r.why_null["phase_crossover"] = "L never crosses the negative real axis at a finite frequency.";
    r.tolerates.gain_low = r.gain_margin_low ? r.gain_margin_low : std::optional<double>(0);
    r.tolerates.gain_high = r.gain_margin;
    r.tolerates.extra_dead_time = r.delay_margin;
}

}  // namespace

Robustness robustness_of(const Peaks& peaks, const Margins& margins) {
    Robustness r;
    r.stable = true;
    const auto store_peak = [&](std::optional<double>& value, const Peak& peak, const char* name) {
        store(value, peak.value, r.why_null, name,
              "The derivative has no filter: |C S| grows without bound with frequency.");
    };
    const auto store_omega = [&](std::optional<double>& value, const Peak& peak, const char* name) {
        store(value, peak.omega, r.why_null, name, "The largest value is the limit at infinite frequency.");
    };
    store_peak(r.Ms, peaks.S, "Ms");
    store_peak(r.Mt, peaks.T, "Mt");
    store_peak(r.Mks, peaks.CS, "Mks");
    store_omega(r.omega_Ms, peaks.S, "omega_Ms");
    store_omega(r.omega_Mt, peaks.T, "omega_Mt");
    store_margins(r, margins);
    const bool by_S = peaks.S.value >= peaks.T.value;
    const Peak& largest = by_S ? peaks.S : peaks.T;
    r.binding = std::string(by_S ? "Ms" : "Mt") +
                (std::isfinite(largest.omega) ? " at omega " + shown(largest.omega) : " at infinite frequency");
    return r;
}

Robustness unstable_robustness(const StabilityCount& count) {
    Robustness r;
    const std::string reason = count.unstable_poles < 0
                                   ? "The closed loop is unstable: |L| does not fall below 1 at high frequency."
                               : count.on_the_boundary ? "The closed loop is on the boundary of stability."
                                                       : "The closed loop is unstable.";
    for (const char* name : {"Ms", "omega_Ms", "Mt", "omega_Mt", "Mks", "gain_margin", "gain_margin_low",
                             "phase_margin_deg", "delay_margin", "gain_crossover", "phase_crossover"})
        r.why_null[name] = reason;
    return r;
}

}  // namespace tunewright
