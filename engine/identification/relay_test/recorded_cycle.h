// The steady oscillation in the record of a relay test, and the plant's frequency response at it.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// One harmonic of the steady oscillation.
struct Harmonic {
    int order = 1;
    std::complex<double> U, Y;  ///< Fourier coefficients of v and y
    std::complex<double> G;     ///< Y/U
    double G_std = 0;           ///< standard deviation of the parts of G, from the scatter over the periods and the
                                ///< noise of y
};

/// The state of rest of the record, and how it is known.
struct RestPoint {
    double v = 0, y = 0;
    bool assumed = false;  ///< neither given nor recorded before the test
};

/// All values are dimensionless, as in the clean record.
struct RecordedCycle {
    double relay_start = 0;  ///< time at which the relay took over
    double start = 0;        ///< start of the steady periods: a switch
    double period = 0;
    int periods = 0;                ///< steady ones
    int recorded_periods = 0;       ///< number of whole periods, steady or not
    double period_scatter = 0;      ///< standard deviation over the steady periods
    double v_mean = 0, y_mean = 0;  ///< over the steady periods
    double v_middle = 0;            ///< middle of the relay's two levels
    double v_half = 0, y_half = 0;  ///< half the swing of v and of y
    double drift = 0;               ///< slope of y's mean from period to period
    bool reversed = false;          ///< y is high when u switches up: the relay of a plant with negative gain
    RestPoint rest;
    std::vector<Harmonic> harmonics;  ///< the first harmonic, then the others that the relay excites and that exceed
                                      ///< the noise

    double y_start() const { return y_mean - 0.5 * drift * period * periods; }  ///< the drifting mean at `start`
    double omega() const { return 6.283185307179586 / period; }
    /// True if the test was meant to show a static gain: the relay's levels are not symmetric around the rest.
    bool biased() const;
    /// Eq. 14 (Liu and Gao): mean of y over mean of v, both as deviations from rest.
    double static_gain() const;
    /// Standard deviation of the mean of y as a deviation from rest: noise and rounding of the rows at rest, and the
    /// changes of y's mean from period to period, extrapolated from rest to the steady periods as a drift and as a
    /// random walk. If the record starts with the relay, it is the standard deviation of one row.
    double mean_std = 0;
    double static_gain_std() const;
};

/// Locates the switches from u, takes the last whole periods that are equal, and pools the Fourier integrals over all
/// of them: u exactly, y by trapezoids, without a drift of y's mean. `noise`: standard deviation of y. Errors:
/// not_identifiable if u does not alternate between two levels, or for fewer than two whole periods.
Expected<RecordedCycle> find_cycle(const CleanRecord& record, double noise);

/// G(sigma + j omega) by Eq. 9 of Liu and Gao, with integrals from the relay's start; sigma > 0, dimensionless. The
/// steady part is pooled over all steady periods.
std::complex<double> shifted_response(const CleanRecord& record, const RecordedCycle& cycle, double sigma);

}  // namespace tunewright
