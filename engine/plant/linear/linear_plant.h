// The form in which every linear plant is computed: gain, zeros and poles, dead time, and a state-space realisation.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// x' = A x + B v, y = C x + D v with v(t) = u(t - L). A is stored row by row, n x n.
struct Realisation {
    int n = 0;
    std::vector<double> A, B, C;
    double D = 0;
};

/// P(s) = gain s^(-integrators) prod(s - z)/prod(s - p) e^(-Ls), proper. Poles and zeros at the origin appear only in
/// `integrators` (negative: zeros at s = 0). Complex ones come in conjugate pairs, neighbours in the list, positive
/// imaginary part first.
class LinearPlant {
public:
    /// Errors: invalid_argument with `where` = "plant/<field>": non-finite numbers, K = 0, L < 0, empty or zero `den`,
    /// improper, shapes of A, B, C; unsupported for a state space with an unstable mode that input or output cannot
    /// reach.
    static Expected<LinearPlant> make(const Plant& plant);

    std::complex<double> at(std::complex<double> s) const;        ///< P(s), dead time included
    std::complex<double> rational(std::complex<double> s) const;  ///< without the dead time
    /// P(j omega) at many frequencies, several times as fast; each value agrees to 1e-12.
    std::vector<std::complex<double>> at(std::span<const double> omega) const;

    double gain() const { return gain_; }
    int integrators() const { return integrators_; }
    double dead_time() const { return L_; }
    std::span<const std::complex<double>> zeros() const { return zeros_; }
    std::span<const std::complex<double>> poles() const { return poles_; }
    const Realisation& realisation() const { return realisation_; }

    int order() const { return static_cast<int>(poles_.size()) + (integrators_ > 0 ? integrators_ : 0); }
    int pole_excess() const;     ///< poles minus zeros, >= 0
    double direct_term() const;  ///< P(infinity) without the dead time: gain if the pole excess is 0, else 0
    int unstable_poles() const;  ///< number in the open right half-plane
    bool has_right_half_plane_zero() const;
    /// The first non-zero term: lim s^integrators P(s) for s -> 0 (static gain, or slope for one integrator).
    double low_frequency_gain() const;
    /// Sum of the lags minus the leads (stable ones: -1/p, -1/z) without the dead time.
    double lag_sum() const;
    /// Dead time plus 1/|p| of every pole except those at 0; 0 if it has neither.
    double time_scale() const;

private:
    double gain_ = 0;
    int integrators_ = 0;
    double L_ = 0;
    std::vector<std::complex<double>> zeros_, poles_;
    Realisation realisation_;
};

}  // namespace tunewright
