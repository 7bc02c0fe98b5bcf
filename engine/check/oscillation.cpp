#include "engine/check/oscillation.h"

#include <algorithm>
#include <cmath>
#include <complex>
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
constexpr std::size_t kMostPeriods = 3;
constexpr std::size_t kSpectrumPoints = 160;
constexpr double kBeside = 0.06;         // of a frequency
constexpr std::size_t kLinePlaces = 33;  // frequencies that are tried for a single sine

/// The window of Hann at row i of n.
double hann(std::size_t i, std::size_t n) {
    return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (double(i) + 0.5) / double(n));
}

/// Power over frequency of a window of the series, at twice as many frequencies as it has of its own.
std::vector<double> power_of(const std::vector<double>& e) {
    const std::size_t n = e.size();
    std::vector<double> padded(quick_length(2 * n), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        padded[i] = hann(i, n) * e[i];
    }
    const Spectrum X = half_spectrum(padded);
    std::vector<double> power(X.size());
    std::ranges::transform(X, power.begin(), [](const auto& value) { return std::norm(value); });
    return power;
}

/// The series through the band about a frequency.
struct Filtered {
    std::vector<double> series;
    double share = 0;  ///< of the power above the slowest oscillation that is looked for
};

class Search {
public:
    explicit Search(const std::vector<double>& error) : n_(error.size()), power_(power_of(error)) {
        std::vector<double> padded(error);
        padded.resize(quick_length(n_), 0.0);
        length_ = padded.size();
        X_ = half_spectrum(padded);
        slowest_ = kFewestCycles / static_cast<double>(n_);
        for (std::size_t k = 0; k < X_.size(); ++k)
            if (frequency(k) >= slowest_) total_ += std::norm(X_[k]);
    }

    /// Cycles per row of the strongest peak, by the power within kPeakWidth; 0: there is no power.
    double strongest(double tilt = 0) const {
        std::vector<double> sum(power_.size() + 1, 0.0);
        for (std::size_t k = 0; k < power_.size(); ++k) sum[k + 1] = sum[k] + power_[k];
        const double per = 1 / static_cast<double>(2 * (power_.size() - 1));
        const auto first = std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(slowest_ / per)));
        const auto last = static_cast<std::size_t>(kHighest / per);
        const auto least = static_cast<std::size_t>(1.5 / static_cast<double>(n_) / per) + 1;
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

    Filtered band(double f) const {
        Spectrum inside(X_.size());
        double power = 0;
        for (std::size_t k = 0; k < X_.size(); ++k) {
            if (!in_band(frequency(k), f)) continue;
            inside[k] = X_[k];
            power += std::norm(X_[k]);
        }
        Filtered out{series_of(inside, length_), total_ > 0 ? power / total_ : 0};
        out.series.resize(n_);
        return out;
    }

    void remove(double f) {
        for (std::size_t k = 0; k < X_.size(); ++k)
            if (in_band(frequency(k), f)) X_[k] = 0;
        const double per = 1 / static_cast<double>(2 * (power_.size() - 1));
        for (std::size_t k = 0; k < power_.size(); ++k)
            if (in_band(per * static_cast<double>(k), f)) power_[k] = 0;
    }

private:
    static bool in_band(double f, double centre) { return f > kBandBelow * centre && f < kBandAbove * centre; }
    double frequency(std::size_t k) const { return static_cast<double>(k) / static_cast<double>(length_); }

    std::size_t n_, length_ = 0;
    std::vector<double> power_;
    Spectrum X_;
    double slowest_ = 0, total_ = 0;
};

/// Where the values cross zero, in rows, at most `count` of them.
std::vector<double> crossings(const std::vector<double>& values, std::size_t count) {
    std::vector<double> at;
    for (std::size_t i = 1; i < values.size() && at.size() < count; ++i)
        if ((values[i - 1] > 0) != (values[i] > 0))
            at.push_back(double(i - 1) + values[i - 1] / (values[i - 1] - values[i]));
    return at;
}

/// Period and regularity T/(3 s) from the crossings of the band's autocorrelation, s the standard deviation of the
/// periods that successive crossings give (Thornhill, Huang and Zhang 2003, Journal of Process Control 13, 91-100).
Period measured(const Filtered& band, double f, double step) {
    Period out{.period = step / f, .share = std::min(1.0, band.share)};
    out.amplitude = std::sqrt(2.0) * deviation(band.series);
    const auto longest = std::min(band.series.size() - 1, static_cast<std::size_t>(0.5 * (kCrossings + 2) / f));
    const auto at = crossings(autocorrelation(band.series, longest), kCrossings);
    if (at.size() < 5) return out;
    std::vector<double> periods;
    for (std::size_t i = 1; i < at.size(); ++i) periods.push_back(2 * (at[i] - at[i - 1]));
    const double period = mean(periods), spread = deviation(periods);
    out.period = step * period;
    out.period_error = step * spread / std::sqrt(static_cast<double>(periods.size()));
    out.regularity = std::min(kMostRegular, period / (3 * spread + 1e-9 * period));
    return out;
}

/// Of the band's power in a single sine near the frequency, and its period, which parabolas refine between the
/// frequencies that are tried.
void find_line(const std::vector<double>& band, double f, Peak& peak) {
    const double n = double(band.size());
    double power = 1e-300;
    for (const double value : band) power += value * value;
    std::vector<double> of_sine(kLinePlaces);
    const auto place = [&](std::size_t k) { return f + (-2 + 4.0 * double(k) / (kLinePlaces - 1)) / n; };
    for (std::size_t k = 0; k < of_sine.size(); ++k) {
        const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi * place(k));
        std::complex<double> sum = 0, here = 1;
        for (const double value : band) {
            sum += value * here;
            here *= turn;
        }
        of_sine[k] = 2 * std::norm(sum) / n;
    }
    const auto best = std::size_t(std::ranges::max_element(of_sine) - of_sine.begin());
    double found = place(best);
    if (best > 0 && best + 1 < of_sine.size()) {
        const double bend = of_sine[best - 1] - 2 * of_sine[best] + of_sine[best + 1];
        if (bend < 0) found += (place(1) - place(0)) * 0.5 * (of_sine[best - 1] - of_sine[best + 1]) / bend;
    }
    peak.line = std::min(1.0, of_sine[best] / power);
    peak.line_period = 1 / found;
}

/// Without the sine, the power just beside it relative to the median of the band: about 1 for a sine from outside over
/// the loop's own noise, large for a loop that hardly damps its own oscillation, whose phase drifts.
double power_beside(const std::vector<double>& x, double f) {
    std::complex<double> turn = std::polar(1.0, 2 * std::numbers::pi * f), here = 1;
    double cc = 0, ss = 0, cs = 0, xc = 0, xs = 0;
    for (const double value : x) {
        cc += here.real() * here.real();
        ss += here.imag() * here.imag();
        cs += here.real() * here.imag();
        xc += value * here.real();
        xs += value * here.imag();
        here *= turn;
    }
    const double det = cc * ss - cs * cs;
    if (!(det > 0)) return 0;
    const double a = (xc * ss - xs * cs) / det, b = (xs * cc - xc * cs) / det;
    std::vector<double> rest(quick_length(x.size()), 0.0);
    here = 1;
    for (std::size_t i = 0; i < x.size(); ++i) {
        rest[i] = hann(i, x.size()) * (x[i] - a * here.real() - b * here.imag());
        here *= turn;
    }
    const Spectrum X = half_spectrum(rest);
    double beside = 0;
    std::size_t count = 0;
    std::vector<double> others;
    for (std::size_t k = 0; k < X.size(); ++k) {
        const double place = double(k) / double(rest.size()) / f;
        if (!(place > kBandBelow && place < kBandAbove)) continue;
        if (std::abs(place - 1) < kBeside) {
            beside += std::norm(X[k]);
            ++count;
        } else {
            others.push_back(std::norm(X[k]));
        }
    }
    if (count == 0 || others.empty()) return 0;
    return beside / double(count) / std::max(median(std::move(others)), 1e-300);
}

/// The largest correlation about `periods` periods, corrected for the pairs that are missing.
double correlation_after(const std::vector<double>& r, double period, double periods, std::size_t n) {
    const double centre = std::round(periods * period), half = std::max(1.0, std::floor(0.2 * period));
    if (!(centre + half < 0.8 * double(n)) || !(centre + half < double(r.size()))) return 0;
    const auto from = r.begin() + std::ptrdiff_t(std::max(0.0, centre - half));
    const auto to = r.begin() + std::ptrdiff_t(centre + half) + 1;
    return *std::max_element(from, to) / (1 - centre / double(n));
}

/// The share of power in even steps of ln(period).
Curve drawn_spectrum(const std::vector<double>& error, double step) {
    const auto power = power_of(error);
    Curve curve;
    const double n = static_cast<double>(error.size());
    const double shortest = std::log(2.0), longest = std::log(n / 2);
    if (!(longest > shortest)) return curve;
    std::vector<double> bins(kSpectrumPoints, 0.0);
    std::vector<char> known(kSpectrumPoints, 0);  // at long periods some steps have no frequency
    double total = 0;
    const double per = 1 / static_cast<double>(2 * (power.size() - 1));
    for (std::size_t k = 1; k < power.size(); ++k) {
        const double place = (-std::log(per * static_cast<double>(k)) - shortest) / (longest - shortest);
        if (place < 0 || place >= 1) continue;
        const auto at = static_cast<std::size_t>(place * kSpectrumPoints);
        bins[at] += power[k];
        known[at] = 1;
        total += power[k];
    }
    for (std::size_t i = 0; i < bins.size() && total > 0; ++i) {
        if (!known[i]) continue;
        curve.x.push_back(step * std::exp(shortest + (longest - shortest) * (double(i) + 0.5) / kSpectrumPoints));
        curve.y.push_back(bins[i] / total);
    }
    return curve;
}

}  // namespace

Peak strongest_peak(std::span<const double> series, double tilt) {
    const double centre = mean(series);
    std::vector<double> x(series.begin(), series.end());
    for (double& value : x) value -= centre;
    const Search search(x);
    const double f = search.strongest(tilt), n = double(x.size());
    Peak peak;
    if (!(f > 0)) return peak;
    const Filtered band = search.band(f);
    const Period period = measured(band, f, 1);
    peak.period = period.period;
    peak.regularity = period.regularity;
    peak.share = period.share;
    peak.cycles = n * f;
    find_line(band.series, f, peak);
    peak.spread = power_beside(x, 1 / peak.line_period);
    const auto longest = std::min(x.size() - 1, std::size_t(4 * peak.period));
    peak.persistence = correlation_after(autocorrelation(band.series, longest), peak.period, 3, x.size());
    return peak;
}

OscillationStudy study_oscillation(const Samples& samples) {
    OscillationStudy study;
    study.error = samples.error();
    const double centre = mean(study.error);
    std::vector<double> e(study.error);
    for (double& value : e) value -= centre;
    study.autocorrelation = autocorrelation(e, e.size() / 2);
    study.spectrum = drawn_spectrum(e, samples.step);
    Search search(e);
    while (study.found.periods.size() < kMostPeriods) {
        const double f = search.strongest();
        if (!(f > 0)) break;
        const Period period = measured(search.band(f), f, samples.step);
        if (period.share < kLeastShare) break;
        if (period.regularity > kRegular)
            study.found.periods.push_back(period);
        else if (study.found.periods.empty())
            study.strongest = period;
        search.remove(f);
        if (++study.looked_at >= 2 * kMostPeriods) break;
    }
    study.found.found = !study.found.periods.empty();
    if (study.found.found) study.strongest = study.found.periods.front();
    return study;
}

}  // namespace tunewright::check
