// Whether the error oscillates, with which periods, and how regularly.
#pragma once

#include <span>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/check/samples.h"

namespace tunewright::check {

/// What further tests need beyond the periods themselves.
struct OscillationStudy {
    Oscillation found;
    std::vector<double> error;            ///< set point minus measurement
    std::vector<double> autocorrelation;  ///< of the error, from lag 0
    Curve spectrum;                       ///< share of the error's power over period, time
    Period strongest;                     ///< the first found one, else the strongest, which is not regular
    std::size_t looked_at = 0;            ///< peaks of the spectrum
};

/// The strongest peak of a series' spectrum; times in rows.
struct Peak {
    double period = 0;       ///< 0: the series is constant
    double regularity = 0;   ///< period over three standard deviations of the periods
    double share = 0;        ///< of the series' power in the peak's band
    double line = 0;         ///< of the band's power in a single sine, 0 to 1
    double line_period = 0;  ///< of that sine
    double spread = 0;       ///< power beside that sine over the band\'s median: high where the phase drifts
    double persistence = 0;  ///< autocorrelation of the band after three periods
    double cycles = 0;       ///< in the series
};

/// `tilt`: power is weighted by frequency to the power -tilt, which prefers slow peaks.
Peak strongest_peak(std::span<const double> series, double tilt = 0);

OscillationStudy study_oscillation(const Samples& samples);

}  // namespace tunewright::check
