#include "engine/check/shape.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr double kPointsPerPeriod = 8;

/// Means of kShapeMeans even stretches, in deviations from their own mean; empty for a constant series.
std::vector<float> thinned(const std::vector<double>& values) {
    const std::size_t n = values.size();
    if (n < kShapeMeans) return {};
    std::vector<double> means(kShapeMeans);
    for (std::size_t k = 0; k < means.size(); ++k) {
        const std::size_t from = k * n / means.size(), to = (k + 1) * n / means.size();
        means[k] = mean(std::span(values).subspan(from, to - from));
    }
    const double centre = mean(means), spread = deviation(means);
    if (!(spread > 0)) return {};
    std::vector<float> out;
    for (const double value : means) out.push_back(static_cast<float>((value - centre) / spread));
    return out;
}

/// The last kShapePoints means over a kPointsPerPeriod-th of the main period.
void add_wave(const Samples& samples, const OscillationStudy& study, double period, double seconds, Shape& shape) {
    const double zero = shape.from - seconds * samples.start;
    const auto count = static_cast<std::size_t>(std::max(1.0, period / samples.step / kPointsPerPeriod));
    const std::size_t points = std::min<std::size_t>(kShapePoints, study.error.size() / count);
    const std::size_t first = study.error.size() - points * count;
    const auto means = block_means(std::span(study.error).subspan(first), count);
    const double centre = mean(means), spread = deviation(means);
    if (!(spread > 0)) return;
    for (const double value : means) shape.wave.push_back(static_cast<float>((value - centre) / spread));
    shape.wave_step = seconds * samples.step * static_cast<double>(count);
    shape.wave_from = zero + seconds * samples.time(first) + 0.5 * shape.wave_step;
}

std::vector<float> bands(const Curve& spectrum, double seconds) {
    std::vector<float> out(kShapeBands, 0.0F);
    const double from = std::log(kShortestBand), to = std::log(kLongestBand);
    for (std::size_t i = 0; i < spectrum.x.size(); ++i) {
        const double place = (std::log(spectrum.x[i] * seconds) - from) / (to - from);
        const auto at = static_cast<std::size_t>(std::clamp(place, 0.0, 0.999999) * kShapeBands);
        out[at] += static_cast<float>(spectrum.y[i]);
    }
    return out;
}

}  // namespace

Shape shape_of(const Samples& samples, const Oscillation& oscillation, const OscillationStudy& study,
               const LoopQuestion& question) {
    Shape shape;
    const double seconds = question.seconds.value_or(1);
    shape.dated = question.start.has_value() && question.seconds.has_value();
    const double zero = question.start.value_or(0);
    shape.from = zero + seconds * samples.start;
    shape.to = shape.from + seconds * samples.duration();
    if (oscillation.found) shape.period = seconds * oscillation.periods.front().period;
    shape.spectrum = bands(study.spectrum, seconds);
    add_wave(samples, study, oscillation.found ? oscillation.periods.front().period : study.strongest.period, seconds,
             shape);
    shape.set_point = thinned(samples.r);
    shape.output = thinned(samples.u);
    return shape;
}

}  // namespace tunewright::check
