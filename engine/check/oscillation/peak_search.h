// The peaks of one series' spectrum: how regular each is, how long it lasts, and whether it is a single sine.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "engine/check/loop_check.h"

namespace tunewright::check {

/// The strongest peak of a series' spectrum; times in rows.
struct Peak {
    double period = 0;       ///< 0: the series is constant
    double regularity = 0;   ///< period over three standard deviations of the periods
    double share = 0;        ///< of the series' power in the peak's band
    double line = 0;         ///< of the band's power in a single sine, 0 to 1
    double line_period = 0;  ///< of that sine
    double spread = 0;       ///< power beside that sine over the band's median: high where the phase drifts
    double persistence = 0;  ///< autocorrelation of the band after three periods
    double cycles = 0;       ///< in the series
};

/// The spectrum of a series about its mean, and what its bands show. Frequencies in cycles per row.
class PeakSearch {
public:
    explicit PeakSearch(std::span<const double> series);

    /// `tilt`: power is weighted by frequency to the power -tilt, which prefers slow peaks.
    Peak strongest(double tilt = 0) const;

    /// Of the strongest peak, by the power close to it; 0: there is no power.
    double frequency_of_strongest(double tilt = 0) const;

    /// The oscillation about a frequency; times in rows.
    Period oscillation_about(double f) const;

    /// Takes the band about a frequency out of the spectrum.
    void remove(double f);

    /// Of the series' whole variance, the share that is looked at: without what is slower than the slowest oscillation.
    double share_looked_at() const { return all_ > 0 ? total_ / all_ : 0; }

    /// The share of power in even steps of ln(period); periods in rows.
    Curve power_over_period() const;

private:
    struct Band;
    Band band(double f) const;
    double power_beside(double f) const;
    double frequency(std::size_t k) const { return static_cast<double>(k) / static_cast<double>(length_); }
    double step_of_power() const { return 1 / static_cast<double>(2 * (power_.size() - 1)); }

    std::vector<double> series_, window_;  ///< about its mean; the window of Hann
    std::vector<double> power_;  ///< of the windowed series, at twice as many frequencies as it has of its own
    std::vector<std::complex<double>> X_;  ///< of the series, padded to length_
    std::size_t length_ = 0;
    double slowest_ = 0, total_ = 0, all_ = 0;  ///< lowest frequency that is looked for; power from there on; all power
};

}  // namespace tunewright::check
