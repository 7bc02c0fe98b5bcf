#include "engine/check/drawing.h"

#include <algorithm>
#include <cmath>

namespace tunewright::check {
namespace {

constexpr std::size_t kExcerptRows = 400;
constexpr double kExcerptPeriods = 8;
constexpr std::size_t kCurvePoints = 200;
constexpr double kCorrelationPeriods = 6;

void append(Trend& trend, const Samples& samples, std::size_t i) {
    trend.t.push_back(samples.time(i));
    trend.y.push_back(samples.y[i]);
    trend.u.push_back(samples.u[i]);
    if (!samples.r.empty()) trend.r.push_back(samples.r[i]);
}

double main_period(const OscillationStudy& study) {
    return study.found.periods.empty() ? 0 : study.found.periods.front().period;
}

}  // namespace

Trend trend_of(const Samples& samples) {
    Trend trend;
    const std::size_t n = samples.size(), stretches = std::min<std::size_t>(kTrendStretches, n);
    for (std::size_t k = 0; k < stretches; ++k) {
        const std::size_t from = k * n / stretches, to = (k + 1) * n / stretches;
        std::vector<std::size_t> extremes;
        for (const auto* values : {&samples.y, &samples.u}) {
            const auto [low, high] =
                std::minmax_element(values->begin() + std::ptrdiff_t(from), values->begin() + std::ptrdiff_t(to));
            extremes.push_back(std::size_t(low - values->begin()));
            extremes.push_back(std::size_t(high - values->begin()));
        }
        std::ranges::sort(extremes);
        extremes.erase(std::unique(extremes.begin(), extremes.end()), extremes.end());
        for (const std::size_t i : extremes) append(trend, samples, i);
    }
    return trend;
}

void draw_details(const Samples& samples, const OscillationStudy& study, LoopCheck& check) {
    const double period = main_period(study);
    const double span = period > 0 ? kExcerptPeriods * period / samples.step : double(kExcerptRows);
    const auto rows = std::min(samples.size(), static_cast<std::size_t>(std::max(double(kExcerptRows), span)));
    const std::size_t every = (rows + kExcerptRows - 1) / kExcerptRows;
    for (std::size_t i = samples.size() - rows; i < samples.size(); i += every) append(check.excerpt, samples, i);
    check.spectrum = study.spectrum;
    const double lags = period > 0 ? kCorrelationPeriods * period / samples.step
                                   : 0.25 * static_cast<double>(study.autocorrelation.size());
    const auto count = std::min(study.autocorrelation.size(), static_cast<std::size_t>(lags) + 1);
    const std::size_t stride = (count + kCurvePoints - 1) / kCurvePoints;
    for (std::size_t k = 0; k < count; k += std::max<std::size_t>(1, stride)) {
        check.autocorrelation.x.push_back(samples.step * static_cast<double>(k));
        check.autocorrelation.y.push_back(study.autocorrelation[k]);
    }
}

}  // namespace tunewright::check
