// A plant that is known only by measured points of its frequency response.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/expected.h"

namespace tunewright {

/// P(j omega) = re + j im at ascending angular frequencies. `unstable_poles` in the open right half-plane and
/// `integrators` are given by the user, because the points do not show them.
struct FrequencyResponse {
    std::vector<double> omega, re, im;
    int unstable_poles = 0;
    int integrators = 0;
};

/// The first error of the points themselves, invalid_argument with `where` = "plant/<field>": columns of unequal
/// length, fewer than 8 points, omega not ascending or not > 0, numbers that are not finite, P = 0.
std::optional<Error> points_fault(const FrequencyResponse& points);

/// The points as a function of frequency: cubic in ln omega for ln |P| and for the unwrapped phase (Hermite, slopes
/// from the parabola through three neighbours).
class MeasuredPlant {
public:
    /// Errors: points_fault(); unsupported if the points are so far apart that the phase is ambiguous (2 rad or more
    /// between neighbours) before it has fallen through -180 degrees, or if the lowest frequency is too high to show
    /// the sign of the static gain (without integrators, the phase is more than 60 degrees from 0 and from 180).
    static Expected<MeasuredPlant> make(const FrequencyResponse& points);

    /// Within [low, high]; beyond them the end's value.
    std::complex<double> at(double omega) const;

    double low() const { return omega_.front(); }
    double high() const { return omega_.back(); }  ///< upper end of the band in which the phase is unambiguous
    const std::vector<double>& omega() const { return omega_; }
    int unstable_poles() const { return unstable_poles_; }
    int integrators() const { return integrators_; }
    double static_sign() const { return static_sign_; }  ///< sign of lim s^integrators P(s) for s -> 0: 1 or -1
    /// The sign that Kp must have: static_sign for an even number of unstable poles.
    double gain_sign() const { return unstable_poles_ % 2 == 0 ? static_sign_ : -static_sign_; }
    /// The last frequency at which the phase, turned by gain_sign, falls through -180 degrees; empty if there is none
    /// in the band.
    std::optional<double> phase_crossover() const;

private:
    double interpolate(const std::vector<double>& value, double omega) const;

    std::vector<double> omega_, log_omega_, log_size_, phase_;
    int unstable_poles_ = 0, integrators_ = 0;
    double static_sign_ = 1;
    double turned_ = 0;  // added to the phase to give that of gain_sign P, from -90 degrees for an integrator, -180 for
                         // an unstable pole
};

}  // namespace tunewright
