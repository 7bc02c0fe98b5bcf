#include "engine/evaluation/robustness_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/loop/worst_case.h"
#include "engine/number_text.h"
#include "engine/numerics/fast_complex.h"

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

namespace {

struct RegionCheck {
    double stable_fraction = 0;
    WorstCase worst;
};

RegionCheck check(const PlantRegion& region, const ParallelPid& controller) {
    const PlantCost cost = [&](const LinearPlant& plant) { return log_sensitivity_peak(plant, controller); };
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
    for (const auto& z : region.ends()) look(z);
    if (std::isfinite(result.worst.cost)) result.worst = find_worst_case(region, cost, {result.worst.z});
    // An unstable plant that the samples missed counts as one more, so that 1 always means that none is known.
    if (all_stable && !std::isfinite(result.worst.cost)) looked_at += 1;
    result.stable_fraction = stable / looked_at;
    return result;
}

}  // namespace

RegionFigures region_figures(const PlantFamily& family, const ParallelPid& controller) {
    RegionFigures figures;
    double fractions = 0, worst = -INFINITY;
    for (const auto& region : family.regions) {
        const RegionCheck found = check(region, controller);
        fractions += found.stable_fraction;
        if (found.worst.cost <= worst) continue;
        worst = found.worst.cost;
        figures.worst_plant = region.at(found.worst.z);
    }
    figures.stable_fraction = fractions / static_cast<double>(family.regions.size());
    figures.worst_Ms = finite_or(std::exp(worst), "The loop is unstable on at least one plant, such as worst_plant.");
    return figures;
}

namespace {

constexpr double kSmoothStep = 0.06;  // between neighbours on the Nyquist curve, where |L| < kNear
constexpr double kNear = 4;
constexpr double kLeastShownS = 1e-3, kLeastShownT = 1e-4;  // beyond them the curves show nothing

struct Sample {
    double omega;
    LoopPoint point;
};

/// The part of the grid that shows something.
std::vector<Sample> visible(const LoopGrid& grid) {
    std::size_t first = 0, last = grid.omega.size() - 1;
    while (first + 2 <= last && magnitude(grid.point[first + 1].S) < kLeastShownS) ++first;
    while (last > first + 2 && magnitude(grid.point[last - 1].T) < kLeastShownT) --last;
    std::vector<Sample> samples;
    for (std::size_t i = first; i <= last; ++i)
        if (std::isfinite(magnitude(grid.point[i].L))) samples.push_back({grid.omega[i], grid.point[i]});
    return samples;
}

/// Halves the longest chords of the Nyquist curve while points are left.
std::vector<Sample> smoothed(const Loop& loop, std::vector<Sample> samples, std::size_t points) {
    for (int round = 0; round < 6; ++round) {
        std::vector<Sample> finer;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            finer.push_back(samples[i]);
            if (i + 1 == samples.size() || finer.size() + samples.size() - i >= points) continue;
            const auto a = samples[i].point.L, b = samples[i + 1].point.L;
            if (magnitude(a - b) < kSmoothStep * std::max(1.0, magnitude(a)) ||
                std::min(magnitude(a), magnitude(b)) > kNear)
                continue;
            const double middle = std::sqrt(samples[i].omega * samples[i + 1].omega);
            finer.push_back({middle, loop.at(middle)});
        }
        if (finer.size() == samples.size()) break;
        samples = std::move(finer);
    }
    return samples;
}

FrequencyTraces traces_of(const std::vector<Sample>& samples, std::size_t most) {
    const std::size_t stride = std::max<std::size_t>(1, (samples.size() + most - 1) / most);
    FrequencyTraces traces;
    double phase = 0, previous = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LoopPoint& p = samples[i].point;
        const double wrapped = std::arg(p.L);
        phase = i == 0 ? wrapped : phase + std::remainder(wrapped - previous, 2 * std::numbers::pi);
        previous = wrapped;
        if (i % stride != 0) continue;
        traces.omega.push_back(samples[i].omega);
        traces.L_re.push_back(p.L.real());
        traces.L_im.push_back(p.L.imag());
        traces.L_phase_deg.push_back(phase * 180 / std::numbers::pi);
        traces.S_abs.push_back(std::abs(p.S));
        traces.T_abs.push_back(std::abs(p.T));
        traces.CS_abs.push_back(std::abs(p.CS));
    }
    return traces;
}

}  // namespace

FrequencyTraces frequency_traces(const Loop& loop, const LoopGrid& grid, int points) {
    const auto most = static_cast<std::size_t>(points);
    return traces_of(smoothed(loop, visible(grid), most), most);
}

FrequencyTraces frequency_traces(const MeasuredLoop& loop, int points) {
    std::vector<Sample> samples;
    for (const double omega : loop.omega()) samples.push_back({omega, loop.at(omega)});
    return traces_of(samples, static_cast<std::size_t>(points));
}

}  // namespace tunewright
