#include "engine/evaluation/robustness_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/loop/sampled/sampled_loop.h"
#include "engine/loop/worst_case.h"
#include "engine/number_text.h"
#include "engine/numerics/fast_complex.h"

namespace tunewright {

namespace {

/// Stores the margins; the reasons are given for frequencies at which |L| = 1 or L is real.
void store_margins(Robustness& r, const Margins& m) {
    const std::string no_gain_crossover = "|L| never crosses 1.";
    r.gain_margin = finite_or(m.gain_margin, "No higher gain destabilises the loop.");
    r.gain_margin_low = m.gain_margin_low > 0 ? Figure(m.gain_margin_low)
                                              : no_figure(
                                                    "No lower gain destabilises the "
                                                    "loop.");
    r.phase_margin_deg = finite_or(m.phase_margin * 180 / std::numbers::pi, no_gain_crossover);
    r.delay_margin = finite_or(m.delay_margin, "No extra dead time destabilises the loop.");
    r.gain_crossover = r.phase_margin_deg ? Figure(m.gain_crossover) : no_figure(no_gain_crossover);
    const bool crosses = (r.gain_margin || r.gain_margin_low) && std::isfinite(m.phase_crossover);
    r.phase_crossover = crosses ? Figure(m.phase_crossover)
                                : no_figure("L never crosses the negative real axis at a finite frequency.");
    r.tolerates.gain_low = r.gain_margin_low.value_or(0);
    r.tolerates.gain_high = r.gain_margin;
    r.tolerates.extra_dead_time = r.delay_margin;
}

}  // namespace

Robustness robustness_of(const AnyLoop& loop, const LoopGrid& grid) {
    const Peaks peaks = find_peaks(loop, grid);
    Robustness r;
    r.stable = true;
    const std::string unbounded = "The derivative has no filter: |C S| grows without bound with frequency.",
                      at_infinity = "The largest value is the limit at infinite frequency.";
    r.Ms = finite_or(peaks.S.value, unbounded);
    r.Mt = finite_or(peaks.T.value, unbounded);
    r.Mks = finite_or(peaks.CS.value, unbounded);
    r.omega_Ms = finite_or(peaks.S.omega, at_infinity);
    r.omega_Mt = finite_or(peaks.T.omega, at_infinity);
    store_margins(r, find_margins(loop, grid));
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

namespace {

struct RegionCheck {
    double stable_fraction = 0;
    WorstCase worst;
};

RegionCheck check(const PlantRegion& region, const PlantCost& cost) {
    RegionCheck result{0, {PlantRegion::Point(static_cast<std::size_t>(region.dimension()), 0.0), -INFINITY}};
    const auto look = [&](const PlantRegion::Point& z) {
        const auto plant = LinearPlant::make(region.at(z));
        const double value = plant ? cost(*plant) : INFINITY;
        if (value > result.worst.cost) result.worst = {z, value};
        return std::isfinite(value);
    };
    const auto points = region.spread(kRegionSamples);
    double looked_at = static_cast<double>(points.size()), stable = 0;
    for (const auto& z : points) stable += look(z) ? 1 : 0;
    const bool all_stable = std::isfinite(result.worst.cost);
    look(PlantRegion::Point(static_cast<std::size_t>(region.dimension()), 0.0));
    for (const auto& z : region.ends()) look(z);
    if (std::isfinite(result.worst.cost)) result.worst = find_worst_case(region, cost, {result.worst.z});
    // An unstable plant that the samples missed counts as one more, so that 1 always means that no unstable plant is
    // known.
    if (all_stable && !std::isfinite(result.worst.cost)) looked_at += 1;
    result.stable_fraction = stable / looked_at;
    return result;
}

/// `log_Ms`: ln Ms of the controller on a plant.
RegionFigures figures_over(const PlantFamily& family, const PlantCost& log_Ms) {
    RegionFigures figures;
    double fractions = 0, worst = -INFINITY;
    for (const auto& region : family.regions) {
        const RegionCheck found = check(region, log_Ms);
        fractions += found.stable_fraction;
        if (found.worst.cost <= worst) continue;
        worst = found.worst.cost;
        figures.worst_plant = region.at(found.worst.z);
    }
    figures.stable_fraction = fractions / static_cast<double>(family.regions.size());
    figures.worst_Ms = finite_or(std::exp(worst), "The loop is unstable on at least one plant, such as worst_plant.");
    return figures;
}

}  // namespace

RegionFigures region_figures(const PlantFamily& family, const ParallelPid& controller) {
    return figures_over(family, [&](const LinearPlant& plant) { return log_sensitivity_peak(plant, controller); });
}

RegionFigures region_figures(const PlantFamily& family, const SampledPid& law) {
    return figures_over(family, [&](const LinearPlant& plant) {
        if (refuse_sampling(plant, law.Ts, law.computation_delay)) return static_cast<double>(INFINITY);
        return std::log(SampledLoop(plant, law).sensitivity_peak().value);
    });
}

namespace {

constexpr double kMinShownS = 1e-3, kMinShownT = 2e-3;  // smaller values are not visible in the plots
constexpr double kFullDetailModulus = 0.3;              // of |L|: closer to the origin the curve needs less detail, and
constexpr double kMinVisibleModulus = 0.02;             // below this its turns are not followed
constexpr double kTurnUnit = 0.1;                       // rad of L that weigh as much as
constexpr double kLogModulusUnit = 0.2;                 // this change of ln |L| or
constexpr double kLogFrequencyUnit = 0.15;              // this one of ln omega

/// The part of the grid that is visible in the plots.
LoopGrid visible(const LoopGrid& grid) {
    std::size_t first = 0, last = grid.omega.size() - 1;
    while (first + 2 <= last && magnitude(grid.point[first + 1].S) < kMinShownS) ++first;
    while (last > first + 2 && magnitude(grid.point[last - 1].T) < kMinShownT) --last;
    LoopGrid seen;
    seen.omega.reserve(last - first + 1);
    seen.point.reserve(last - first + 1);
    for (std::size_t i = first; i <= last; ++i) {
        if (!std::isfinite(magnitude(grid.point[i].L))) continue;
        seen.omega.push_back(grid.omega[i]);
        seen.point.push_back(grid.point[i]);
    }
    return seen;
}

/// The visible part of a turn at |L|: a chord leaves the arc by |L| turn^2 / 8.
double seen_at(double gain) {
    return gain < kMinVisibleModulus ? 0 : std::min(1.0, std::sqrt(gain / kFullDetailModulus));
}

/// Visible length of the curves up to each frequency: turning of L, growth of |L| and omega, each in its unit. `turns`:
/// the phase of L, unwrapped.
std::vector<double> progress_along(const LoopGrid& grid, const std::vector<double>& turns) {
    std::vector<double> along{0};
    along.reserve(grid.omega.size());
    for (std::size_t i = 1; i < grid.omega.size(); ++i) {
        const double a = magnitude(grid.point[i - 1].L), b = magnitude(grid.point[i].L);
        const double seen = seen_at(std::max(a, b));
        const double turn = (turns[i] - turns[i - 1]) / kTurnUnit, change = std::log(b / a) / kLogModulusUnit;
        const double ratio = std::log(grid.omega[i] / grid.omega[i - 1]) / kLogFrequencyUnit;
        const double curve = std::isfinite(change) ? std::hypot(turn, change) : std::abs(turn);
        along.push_back(along.back() + seen * curve + ratio);
    }
    return along;
}

/// The phase plus the multiple of 2 pi that brings it nearest to `nearby`.
double on_turn(double phase, double nearby) {
    constexpr double kFullTurn = 2 * std::numbers::pi;
    return phase - kFullTurn * std::floor((phase - nearby) / kFullTurn + 0.5);
}

/// The unwrapped phase of L at each frequency, including the dead time's turns between neighbours.
std::vector<double> unwrapped(const LoopGrid& grid, double dead_time) {
    std::vector<double> turns(grid.omega.size());
    double rest = 0;  // the phase without the dead time's own
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const double of_dead_time = grid.omega[i] * dead_time, own = std::arg(grid.point[i].L) + of_dead_time;
        rest = i == 0 ? own : on_turn(own, rest);
        turns[i] = rest - of_dead_time;
    }
    return turns;
}

/// At most `max` frequencies, evenly spread along the curves, with those of `kept` (ascending) among them.
std::vector<double> spread(const LoopGrid& grid, const std::vector<double>& along, std::size_t max,
                           const std::vector<double>& kept) {
    const std::size_t count = max > kept.size() + 2 ? max - kept.size() : max;
    std::vector<double> omega;
    omega.reserve(max);
    std::size_t i = 1, spaced = 0;  // `ratio`: ratio of the frequencies around `spaced`
    double ratio = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double wanted = along.back() * static_cast<double>(k) / static_cast<double>(count - 1);
        while (i + 1 < along.size() && along[i] < wanted) ++i;
        const double part = std::clamp((wanted - along[i - 1]) / (along[i] - along[i - 1]), 0.0, 1.0);
        if (i != spaced) {
            spaced = i;
            ratio = std::log(grid.omega[i] / grid.omega[i - 1]);
        }
        omega.push_back(grid.omega[i - 1] * std::exp(part * ratio));
    }
    const double first = omega.front(), last = omega.back();
    const auto spread_evenly = static_cast<std::ptrdiff_t>(omega.size());
    if (count < max)
        for (const double frequency : kept)
            if (frequency > first && frequency < last) omega.push_back(frequency);
    std::ranges::inplace_merge(omega, omega.begin() + spread_evenly);
    omega.erase(std::unique(omega.begin(), omega.end()), omega.end());
    return omega;
}

FrequencyTraces traces_of(const LoopGrid& grid, const std::vector<double>& turns) {
    FrequencyTraces traces;
    traces.omega = grid.omega;
    const std::size_t n = grid.omega.size();
    for (auto* trace : {&traces.L_re, &traces.L_im, &traces.L_phase_deg, &traces.S_abs, &traces.T_abs, &traces.CS_abs})
        trace->resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const LoopPoint& p = grid.point[i];
        traces.L_re[i] = p.L.real();
        traces.L_im[i] = p.L.imag();
        traces.L_phase_deg[i] = turns[i] * 180 / std::numbers::pi;
        traces.S_abs[i] = magnitude(p.S);
        traces.T_abs[i] = magnitude(p.T);
        traces.CS_abs[i] = magnitude(p.CS);
    }
    return traces;
}

}  // namespace

FrequencyTraces frequency_traces(const Loop& loop, const LoopGrid& grid, int points, const std::vector<double>& kept) {
    const LoopGrid seen = visible(grid);
    const std::vector<double> turns = unwrapped(seen, loop.plant().dead_time());
    if (seen.omega.size() < 2) return traces_of(seen, turns);
    LoopGrid shown;
    shown.omega = spread(seen, progress_along(seen, turns), static_cast<std::size_t>(points), kept);
    shown.point = loop.at(shown.omega);
    std::vector<double> phase(shown.omega.size());
    std::size_t i = 1;
    for (std::size_t k = 0; k < phase.size(); ++k) {
        const double omega = shown.omega[k];
        while (i + 1 < seen.omega.size() && seen.omega[i] < omega) ++i;
        // Between neighbours the dead time's turning is known; the other parts change little.
        const double part = (omega - seen.omega[i - 1]) / (seen.omega[i] - seen.omega[i - 1]);
        phase[k] = on_turn(std::arg(shown.point[k].L), turns[i - 1] + part * (turns[i] - turns[i - 1]));
    }
    return traces_of(shown, phase);
}

FrequencyTraces frequency_traces(const LoopGrid& whole, int points) {
    LoopGrid some;
    const std::size_t max = static_cast<std::size_t>(points),
                      stride = std::max<std::size_t>(1, (whole.omega.size() + max - 1) / max);
    const std::vector<double> turns = unwrapped(whole, 0);
    std::vector<double> phase;
    for (std::size_t i = 0; i < whole.omega.size(); i += stride) {
        some.omega.push_back(whole.omega[i]);
        some.point.push_back(whole.point[i]);
        phase.push_back(turns[i]);
    }
    return traces_of(some, phase);
}

}  // namespace tunewright
