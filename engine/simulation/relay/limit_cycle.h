// The figures of a relay test's steady oscillation, from a simulation or a record.
#pragma once

#include <optional>

#include "engine/loop/margins.h"

namespace tunewright {

/// G(sigma + j 2 pi/Pu) = A e^(j phi) (Liu and Gao, Eq. 9), phi in (-2 pi, 0].
struct ShiftedPoint {
    double sigma = 0;  ///< 1/time; the paper's alpha
    double A = 0;
    double phi = 0;
};

/// G(j 2 pi/Pu) = Au e^(j phi_u) (Liu and Gao, Eq. 4), phi_u in (-2 pi, 0].
struct LimitCycle {
    double Pu = 0;  ///< period
    double Au = 0;  ///< y per u
    double phi_u = 0;
    int periods = 0;  ///< whole steady periods used; for a simulated cycle those in its record
    std::optional<ShiftedPoint> shift;
    std::optional<double> fit_rms;  ///< root of Eq. 15's mean square: model against record over the steady periods, y
    std::optional<UltimatePoint> describing_function;  ///< 4 d/(pi a) with the relay's and y's amplitudes
    std::optional<double> t_plus, t_minus;             ///< times for which u is at its upper and at its lower level
    std::optional<double> y_max, y_min;                ///< largest and smallest y of the steady oscillation
};

/// A measured value of the plant's frequency response.
struct FrequencyPoint {
    double omega = 0;
    double re = 0, im = 0;
    double std = 0;  ///< standard deviation of re and of im
};

}  // namespace tunewright
