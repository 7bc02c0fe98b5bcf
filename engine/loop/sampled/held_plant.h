// A linear plant behind a zero-order hold, sampled once every sample time: exact for any ratio of dead time and sample
// time.
//
//   x_{k+1} = Phi x_k + Gamma1 u_{k-d-1} + Gamma0 u_{k-d},   y_k = C x_k + D u_{k-d-1},   dead time = d Ts + delta,
//   Phi = e^(A Ts),  Gamma0 = psi(Ts - delta) B,  Gamma1 = e^(A (Ts - delta)) psi(delta) B,  psi(h) = int_0^h e^(A s)
//   ds.
//
// The program reads y_k just before its output changes, so no output depends on itself. Source: Åström and Wittenmark,
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

/// Largest dead time in sample times: longer ones do not occur in practice, and their cost would be unbounded.
inline constexpr int kMaxDelaySamples = 100'000;

/// An error at implement/sample_time if dead time and computation delay together are longer than that.
std::optional<Error> refuse_sampling(const LinearPlant& plant, double sample_time, double computation_delay);

class HeldPlant {
public:
    /// `plant` must outlive this object. `sample_time` > 0; `computation_delay` >= 0 adds to the dead time, which ends
    /// after 1e9 sample times.
    HeldPlant(const LinearPlant& plant, double sample_time, double computation_delay);

    const LinearPlant& plant() const { return *plant_; }
    double sample_time() const { return Ts_; }
    int whole_samples() const { return d_; }  ///< d
    double rest() const { return delta_; }    ///< delta, 0 <= delta < Ts

    /// The pulse transfer function at z = e^(j omega Ts), 0 <= omega <= pi/Ts. Not finite at a pole on the circle.
    std::complex<double> at(double omega) const { return at(omega, UnitCircle(omega * Ts_)); }
    std::complex<double> at(double omega, const UnitCircle& z) const;  ///< the same with z already known
    /// e^(p Ts) of every pole, including those at 0.
    const std::vector<std::complex<double>>& poles() const { return poles_; }

private:
    const LinearPlant* plant_;
    double Ts_, delta_ = 0;
    int d_ = 0;
    std::vector<double> E_;  // Phi - I, from the integral: accurate also for small sample times
    std::vector<double> Gamma0_, Gamma1_;
    std::vector<std::complex<double>> poles_;
};

/// A dead time as whole samples, at most 1e9, and a rest shorter than one; a multiple up to rounding counts as a
/// multiple.
struct SampledDelay {
    int whole = 0;
    double rest = 0;
};
SampledDelay in_samples(double delay, double sample_time);

/// psi(h) = int_0^h e^(A s) ds, n x n, row by row.
std::vector<double> integrated_exponential(std::span<const double> A, int n, double h);

}  // namespace tunewright
