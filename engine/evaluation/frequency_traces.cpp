#include "engine/evaluation/frequency_traces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/numerics/fast_complex.h"

namespace tunewright {
namespace {

constexpr double kSmoothStep = 0.06;  // between neighbours on the Nyquist curve, where |L| < kNear
constexpr double kNear = 4;

struct Sample {
    double omega;
    LoopPoint point;
};

/// The part of the grid that shows something: from |S| = 0.001 to |T| = 0.0001.
std::vector<Sample> visible(const LoopGrid& grid) {
    std::size_t first = 0, last = grid.omega.size() - 1;
    while (first + 2 <= last && magnitude(grid.point[first + 1].S) < 1e-3) ++first;
    while (last > first + 2 && magnitude(grid.point[last - 1].T) < 1e-4) --last;
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
