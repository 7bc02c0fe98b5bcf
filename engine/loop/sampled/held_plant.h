// A linear plant behind a zero-order hold, seen once every sample time: exact, whatever the dead time is of the sample
// time.
//
//   x_{k+1} = Phi x_k + Gamma1 u_{k-d-1} + Gamma0 u_{k-d},   y_k = C x_k + D u_{k-d-1},   dead time = d Ts + delta,
//   Phi = e^(A Ts),  Gamma0 = psi(Ts - delta) B,  Gamma1 = e^(A (Ts - delta)) psi(delta) B,  psi(h) = int_0^h e^(A s)
//   ds.
//
// The program reads y_k just before its output changes, so no output depends on itself. Source: Astrom and Wittenmark,
// Computer-Controlled Systems (3rd ed. 1997), section 2.3 (fractional dead times).
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// z = e^(j angle) and its differences from one, each without cancellation.
struct UnitCircle {
    explicit UnitCircle(double angle);
    std::complex<double> back;            ///< 1/z
    std::complex<double> one_minus_back;  ///< 1 - 1/z
    std::complex<double> minus_one;       ///< z - 1
};

/// Sample times that a dead time may last: more are no loop that anybody runs, and cost without end.
inline constexpr int kMaxDelaySamples = 100'000;

/// An error at implement/sample_time where dead time and computation delay together last longer than that.
std::optional<Error> refuse_sampling(const LinearPlant& plant, double sample_time, double computation_delay);

class HeldPlant {
public:
    /// `plant` is kept and must outlive this. `sample_time` > 0; `computation_delay` >= 0 adds to the dead time, which
    /// ends after 1e9 sample times.
    HeldPlant(const LinearPlant& plant, double sample_time, double computation_delay);

    const LinearPlant& plant() const { return *plant_; }
    double sample_time() const { return Ts_; }
    int whole_samples() const { return d_; }  ///< d
    double rest() const { return delta_; }    ///< delta, 0 <= delta < Ts

    /// The pulse transfer function at z = e^(j omega Ts), 0 <= omega <= pi/Ts. Not finite at a pole on the circle.
    std::complex<double> at(double omega) const { return at(omega, UnitCircle(omega * Ts_)); }
    std::complex<double> at(double omega, const UnitCircle& z) const;  ///< the same where z is known already
    /// e^(p Ts) of every pole, those at 0 included.
    const std::vector<std::complex<double>>& poles() const { return poles_; }

private:
    const LinearPlant* plant_;
    double Ts_, delta_ = 0;
    int d_ = 0;
    std::vector<double> E_;  // Phi - I, from the integral: exact also for small sample times
    std::vector<double> Gamma0_, Gamma1_;
    std::vector<std::complex<double>> poles_;
};

/// A dead time in whole samples, 1e9 at most, and a rest below one; what is a multiple to rounding counts as one.
struct SampledDelay {
    int whole = 0;
    double rest = 0;
};
SampledDelay in_samples(double delay, double sample_time);

/// psi(h) = int_0^h e^(A s) ds, n x n, row by row.
std::vector<double> integrated_exponential(std::span<const double> A, int n, double h);

}  // namespace tunewright
