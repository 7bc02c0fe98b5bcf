#include "engine/identification/data_quality.h"

#include <algorithm>
#include <cmath>

#include "engine/identification/record_kind.h"
#include "engine/identification/wording.h"

namespace tunewright {
namespace {

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void describe_sampling(const CleanRecord& r, DataQuality& quality) {
    std::vector<double> spacings;
    for (std::size_t i = 1; i < r.t.size(); ++i) {
        if (r.t[i] > r.t[i - 1]) spacings.push_back(r.t[i] - r.t[i - 1]);
    }
    const double typical = median(spacings);
    const auto odd = std::count_if(spacings.begin(), spacings.end(),
                                   [&](double d) { return std::abs(d - typical) > 0.1 * typical; });
    quality.sample_time = typical * r.scale.t_scale;
    quality.irregular = static_cast<double>(odd) > 0.01 * static_cast<double>(spacings.size());
}

}  // namespace

double noise_std(std::span<const double> y) {
    // A second difference of white noise has six times its variance; the median of |.| of a normal variable is 0.6745
    // of its deviation.
    std::vector<double> differences;
    double squares = 0;
    for (std::size_t i = 2; i < y.size(); ++i) {
        const double d = y[i] - 2 * y[i - 1] + y[i - 2];
        differences.push_back(std::abs(d));
        squares += d * d;
    }
    if (differences.empty()) return 0;
    const double by_square = std::sqrt(squares / static_cast<double>(differences.size()) / 6);
    const double by_median = median(std::move(differences)) / 0.6745 / std::sqrt(6.0);
    return by_median > 0 ? std::min(by_median, by_square) : by_square;
}

double quantisation_step(std::span<const double> y) {
    std::vector<double> values(y.begin(), y.end());
    std::sort(values.begin(), values.end());
    const double range = values.back() - values.front();
    const double same = 1e-9 * std::max(range, std::max(std::abs(values.front()), std::abs(values.back())));
    values.erase(std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a <= same; }),
                 values.end());
    if (values.size() < 3) return 0;
    double smallest = range;
    for (std::size_t i = 1; i < values.size(); ++i) smallest = std::min(smallest, values[i] - values[i - 1]);
    double count = 0;
    for (std::size_t i = 1; i < values.size(); ++i) count += std::round((values[i] - values[i - 1]) / smallest);
    const double step = range / count;
    for (double value : values) {
        const double places = (value - values.front()) / step;
        if (std::abs(places - std::round(places)) > 0.1) return 0;
    }
    return step;
}

DataQuality describe_record(const CleanRecord& r) {
    DataQuality quality;
    quality.kind = r.kind == RecordKind::automatic ? found_kind(r) : r.kind;
    quality.samples = r.samples();
    quality.steps = r.changes();
    quality.samples_dropped = r.dropped;
    describe_sampling(r, quality);
    quality.noise_std = noise_std(r.y) * r.scale.y_scale;
    quality.quantisation = quantisation_step(r.y) * r.scale.y_scale;
    if (r.dropped > 0) {
        quality.notes.push_back(
            std::to_string(r.dropped) + " rows were left out (no number, or a time before the row above)" +
            (r.u_only > 0 ? "; u of " + std::to_string(r.u_only) + " of them, whose y is no number, was used." : "."));
    }
    if (quality.irregular) quality.notes.push_back("The samples are not evenly spaced; each is used at its own time.");
    if (quality.quantisation > 0.5 * quality.noise_std && quality.quantisation > 1e-3 * r.scale.y_scale) {
        quality.notes.push_back("y lies on a grid of " + number_text(quality.quantisation) + " (its range is " +
                                number_text(r.scale.y_scale) + ").");
    }
    return quality;
}

}  // namespace tunewright
