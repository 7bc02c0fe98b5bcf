#include "engine/check/oscillation/peak_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/check/thresholds.h"
#include "engine/numerics/fourier.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

using Spectrum = std::vector<std::complex<double>>;

constexpr double kBandBelow = 0.55, kBandAbove = 1.6;  // of the peak's frequency: what belongs to an oscillation
constexpr double kPeakWidth = 0.08;                    // of a frequency: power this close counts as one peak's
constexpr double kHighest = 0.45;                      // cycles per row
constexpr double kFewestCycles = 4;                    // in the record, of the slowest oscillation looked for
constexpr int kCrossings = 12;                         // of the autocorrelation, hence eleven intervals
constexpr double kPersistencePeriods = 3;
constexpr double kAboutPersistent = 0.2;  // of a period
constexpr std::size_t kSpectrumPoints = 160;
constexpr double kBeside = 0.06;         // of a frequency
constexpr std::size_t kLinePlaces = 33;  // frequencies that are tried for a single sine
constexpr double kLineWidth = 2;         // of 1/rows, on either side
constexpr std::size_t kLineBlocks = 512;

bool in_band(double f, double centre) { return f > kBandBelow * centre && f < kBandAbove * centre; }

/// exp(i turn k) for successive k, without a call of a trigonometric function for each.
class Rotation {
public:
    explicit Rotation(double turn, double start = 0) : turn_(std::polar(1.0, turn)), here_(std::polar(1.0, start)) {}
    std::complex<double> next() {
        const auto now = here_;
        here_ *= turn_;
        return now;
    }

private:
    std::complex<double> turn_, here_;
};

std::vector<double> hann_window(std::size_t n) {
    const double turn = 2 * std::numbers::pi / double(n);
    Rotation rotation(turn, 0.5 * turn);
    std::vector<double> window(n);
    for (double& value : window) value = 0.5 - 0.5 * rotation.next().real();
    return window;
}

/// Where the values cross zero, in rows, at most `count` of them.
std::vector<double> crossings(const std::vector<double>& values, std::size_t count) {
    std::vector<double> at;
    for (std::size_t i = 1; i < values.size() && at.size() < count; ++i)
        if ((values[i - 1] > 0) != (values[i] > 0))
            at.push_back(double(i - 1) + values[i - 1] / (values[i - 1] - values[i]));
    return at;
}

/// The largest correlation about three periods, corrected for the pairs that are missing.
double persistence(const std::vector<double>& r, double period, std::size_t n) {
    const double centre = std::round(kPersistencePeriods * period),
                 half = std::max(1.0, std::floor(kAboutPersistent * period));
    if (!(centre + half < 0.8 * double(n)) || !(centre + half < double(r.size()))) return 0;
    const auto from = r.begin() + std::ptrdiff_t(std::max(0.0, centre - half));
    const auto to = r.begin() + std::ptrdiff_t(centre + half) + 1;
    return *std::max_element(from, to) / (1 - centre / double(n));
}

/// Of the band's power in a single sine near the frequency, and its period, which parabolas refine between the
/// frequencies that are tried. Those are so near that the phases hardly differ within a block.
void find_line(const std::vector<double>& band, double f, Peak& peak) {
    const double n = double(band.size());
    const std::size_t length = (band.size() + kLineBlocks - 1) / kLineBlocks;
    std::vector<std::complex<double>> blocks;
    double power = 1e-300;
    Rotation rotation(-2 * std::numbers::pi * f);
    for (std::size_t i = 0; i < band.size(); ++i) {
        if (i % length == 0) blocks.emplace_back(0);
        blocks.back() += band[i] * rotation.next();
        power += band[i] * band[i];
    }
    std::vector<double> of_sine(kLinePlaces);
    const auto place = [&](std::size_t k) { return kLineWidth * (2 * double(k) / (kLinePlaces - 1) - 1) / n; };
    for (std::size_t k = 0; k < of_sine.size(); ++k) {
        Rotation further(-2 * std::numbers::pi * place(k) * double(length));
        std::complex<double> sum = 0;
        for (const auto& block : blocks) sum += block * further.next();
        of_sine[k] = 2 * std::norm(sum) / n;
    }
    const auto best = std::size_t(std::ranges::max_element(of_sine) - of_sine.begin());
    double found = place(best);
    if (best > 0 && best + 1 < of_sine.size()) {
        const double bend = of_sine[best - 1] - 2 * of_sine[best] + of_sine[best + 1];
        if (bend < 0) found += (place(1) - place(0)) * 0.5 * (of_sine[best - 1] - of_sine[best + 1]) / bend;
    }
    peak.line = std::min(1.0, of_sine[best] / power);
    peak.line_period = 1 / (f + found);
}

}  // namespace

/// The series through the band about a frequency, and its autocorrelation for some periods.
struct PeakSearch::Band {
    std::vector<double> series, autocorrelation;
    double share = 0;  ///< of the power above the slowest oscillation that is looked for

    /// Period and regularity T/(3 s) from the crossings of the autocorrelation, s the standard deviation of the periods
    /// that successive crossings give (Thornhill, Huang and Zhang 2003, Journal of Process Control 13, 91-100).
    Period measured(double f) const {
        Period out{.period = 1 / f, .share = std::min(1.0, share)};
        out.amplitude = std::sqrt(2.0) * deviation(series);
        const auto at = crossings(autocorrelation, kCrossings);
        if (at.size() < 5) return out;
        std::vector<double> periods;
        for (std::size_t i = 1; i < at.size(); ++i) periods.push_back(2 * (at[i] - at[i - 1]));
        const double period = mean(periods), spread = deviation(periods);
        out.period = period;
        out.period_error = spread / std::sqrt(static_cast<double>(periods.size()));
        out.regularity = std::min(kMostRegular, period / (3 * spread + 1e-9 * period));
        return out;
    }
};

PeakSearch::PeakSearch(std::span<const double> series)
    : series_(series.begin(), series.end()), window_(hann_window(series.size())) {
    const double centre = mean(series);
    for (double& value : series_) value -= centre;
    const std::size_t n = series_.size();
    std::vector<double> windowed(2 * quick_length(n), 0.0);
    for (std::size_t i = 0; i < n; ++i) windowed[i] = window_[i] * series_[i];
    const Spectrum of_windowed = half_spectrum(windowed);
    power_.resize(of_windowed.size());
    std::ranges::transform(of_windowed, power_.begin(), [](const auto& value) { return std::norm(value); });
    length_ = quick_length(n);
    std::vector<double> padded(series_);
    padded.resize(length_, 0.0);
    X_ = half_spectrum(padded);
    slowest_ = kFewestCycles / static_cast<double>(n);
    for (std::size_t k = 0; k < X_.size(); ++k) {
        all_ += std::norm(X_[k]);
        if (frequency(k) >= slowest_) total_ += std::norm(X_[k]);
    }
}

double PeakSearch::frequency_of_strongest(double tilt) const {
    std::vector<double> sum(power_.size() + 1, 0.0);
    for (std::size_t k = 0; k < power_.size(); ++k) sum[k + 1] = sum[k] + power_[k];
    const double per = step_of_power();
    const auto first = std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(slowest_ / per)));
    const auto last = static_cast<std::size_t>(kHighest / per);
    const auto least = static_cast<std::size_t>(1.5 / static_cast<double>(series_.size()) / per) + 1;
    double most = 0;
    std::size_t best = 0;
    for (std::size_t k = first; k < last; ++k) {
        const auto half = std::max(least, static_cast<std::size_t>(kPeakWidth * static_cast<double>(k)));
        const std::size_t from = k > half ? k - half : 1, to = std::min(k + half + 1, power_.size());
        const double energy = (sum[to] - sum[from]) * (tilt == 0 ? 1 : std::pow(double(k), -tilt));
        if (energy > most) {
            most = energy;
            best = k;
        }
    }
    if (best == 0) return 0;
    const auto half = least + static_cast<std::size_t>(kPeakWidth * static_cast<double>(best));
    const auto from = power_.begin() + static_cast<std::ptrdiff_t>(best > half ? best - half : 1);
    const auto to = power_.begin() + static_cast<std::ptrdiff_t>(std::min(best + half + 1, power_.size()));
    return per * static_cast<double>(std::max_element(from, to) - power_.begin());
}

PeakSearch::Band PeakSearch::band(double f) const {
    Spectrum inside(X_.size());
    double power = 0;
    for (std::size_t k = 0; k < X_.size(); ++k) {
        if (!in_band(frequency(k), f)) continue;
        inside[k] = X_[k];
        power += std::norm(X_[k]);
    }
    Band out{series_of(inside, length_), {}, total_ > 0 ? power / total_ : 0};
    out.series.resize(series_.size());
    const auto longest = std::min(series_.size() - 1, static_cast<std::size_t>(0.5 * (kCrossings + 2) / f));
    out.autocorrelation = autocorrelation(out.series, longest);
    return out;
}

Period PeakSearch::oscillation_about(double f) const { return band(f).measured(f); }

void PeakSearch::remove(double f) {
    for (std::size_t k = 0; k < X_.size(); ++k)
        if (in_band(frequency(k), f)) X_[k] = 0;
    for (std::size_t k = 0; k < power_.size(); ++k)
        if (in_band(step_of_power() * static_cast<double>(k), f)) power_[k] = 0;
}

/// Without the sine, the power just beside it relative to the median of the band: about 1 for a sine from outside over
/// the loop's own noise, large for a loop that hardly damps its own oscillation, whose phase drifts.
double PeakSearch::power_beside(double f) const {
    const double turn = 2 * std::numbers::pi * f;
    Rotation rotation(turn);
    double cc = 0, ss = 0, cs = 0, xc = 0, xs = 0;
    for (const double value : series_) {
        const auto here = rotation.next();
        cc += here.real() * here.real();
        ss += here.imag() * here.imag();
        cs += here.real() * here.imag();
        xc += value * here.real();
        xs += value * here.imag();
    }
    const double det = cc * ss - cs * cs;
    if (!(det > 0)) return 0;
    const double a = (xc * ss - xs * cs) / det, b = (xs * cc - xc * cs) / det;
    std::vector<double> rest(length_, 0.0);
    rotation = Rotation(turn);
    for (std::size_t i = 0; i < series_.size(); ++i) {
        const auto here = rotation.next();
        rest[i] = window_[i] * (series_[i] - a * here.real() - b * here.imag());
    }
    const Spectrum X = half_spectrum(rest);
    double beside = 0;
    std::size_t count = 0;
    std::vector<double> others;
    for (std::size_t k = 0; k < X.size(); ++k) {
        if (!in_band(frequency(k), f)) continue;
        if (std::abs(frequency(k) / f - 1) < kBeside) {
            beside += std::norm(X[k]);
            ++count;
        } else {
            others.push_back(std::norm(X[k]));
        }
    }
    if (count == 0 || others.empty()) return 0;
    return beside / double(count) / std::max(median(std::move(others)), 1e-300);
}

Peak PeakSearch::strongest(double tilt) const {
    const double f = frequency_of_strongest(tilt);
    Peak peak;
    if (!(f > 0)) return peak;
    const Band about = band(f);
    const Period period = about.measured(f);
    peak.period = period.period;
    peak.regularity = period.regularity;
    peak.share = period.share;
    peak.cycles = double(series_.size()) * f;
    find_line(about.series, f, peak);
    peak.spread = power_beside(1 / peak.line_period);
    peak.persistence = persistence(about.autocorrelation, peak.period, series_.size());
    return peak;
}

Curve PeakSearch::power_over_period() const {
    Curve curve;
    const double shortest = std::log(2.0), longest = std::log(static_cast<double>(series_.size()) / 2);
    if (!(longest > shortest)) return curve;
    std::vector<double> bins(kSpectrumPoints, 0.0);
    std::vector<char> known(kSpectrumPoints, 0);  // at long periods some steps have no frequency
    double total = 0;
    for (std::size_t k = 1; k < power_.size(); ++k) {
        const double place = (-std::log(step_of_power() * static_cast<double>(k)) - shortest) / (longest - shortest);
        if (place < 0 || place >= 1) continue;
        const auto at = static_cast<std::size_t>(place * kSpectrumPoints);
        bins[at] += power_[k];
        known[at] = 1;
        total += power_[k];
    }
    for (std::size_t i = 0; i < bins.size() && total > 0; ++i) {
        if (!known[i]) continue;
        curve.x.push_back(std::exp(shortest + (longest - shortest) * (double(i) + 0.5) / kSpectrumPoints));
        curve.y.push_back(bins[i] / total);
    }
    return curve;
}

}  // namespace tunewright::check
