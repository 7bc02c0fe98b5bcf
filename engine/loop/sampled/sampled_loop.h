// A linear plant with a controller that computes once every sample time, over frequency: the loop of the program's
// samples, 0 <= omega <= pi/Ts.
//
//   L = P(z) C(z), S = 1/(1 + L), T = L/(1 + L), C S at z = e^(j omega Ts), P the plant behind its hold (held_plant.h),
//   C = -u/y of the program with r = 0, its filter included.
//
// Ms and Mt are the suprema of |S| and |T| there, both ends included. As Ts falls they become the continuous loop's.
#pragma once

#include <complex>

#include "engine/controller/sampled/sampled_pid.h"
#include "engine/loop/peaks.h"
#include "engine/loop/sampled/held_plant.h"

namespace tunewright {

/// C(z) of the program, z = e^(j omega Ts); infinite at omega = 0 with integral action.
std::complex<double> pulse_response(const SampledPid& law, double omega, const UnitCircle& z);
inline std::complex<double> pulse_response(const SampledPid& law, double omega) {
    return pulse_response(law, omega, UnitCircle(omega * law.Ts));
}

class SampledLoop {
public:
    /// The plant must outlive this object. `law.Ts` > 0, gains finite.
    SampledLoop(const LinearPlant& plant, const SampledPid& law)
        : plant_(plant, law.Ts, law.computation_delay), law_(law) {}
    /// `plant`: behind a hold of the law's sample time and computation delay.
    SampledLoop(const HeldPlant& plant, const SampledPid& law) : plant_(plant), law_(law) {}

    LoopPoint at(double omega) const;  ///< 0 < omega <= pi/Ts; at 0 without integrators in plant and controller
    std::complex<double> open_loop(double omega) const;

    LoopGrid ends() const;  ///< S = 0 at 0 with an integrator
    /// Turning of z and of the dead time.
    double turning_time() const { return law_.Ts * (plant_.whole_samples() + 1) + plant_.rest(); }
    bool finite_at_zero() const;

    /// The peak of |S| alone, to 1e-9, at a third of the cost; infinite if the loop is unstable.
    Peak sensitivity_peak() const;
    /// True if the loop is stable with Ms <= `limit`, which is above 1; at a tenth of the cost.
    bool keeps(double limit) const;

    const HeldPlant& plant() const { return plant_; }
    const SampledPid& law() const { return law_; }
    double highest_frequency() const;  ///< pi/Ts

private:
    HeldPlant plant_;
    SampledPid law_;
};

/// As that of a Loop, up to pi/Ts.
LoopGrid make_loop_grid(const SampledLoop& loop, const Refinement& refinement = 0.15, int density = 24);

/// Closed-loop poles on and outside the unit circle, by the argument principle along it.
StabilityCount count_unstable_poles(const SampledLoop& loop);
StabilityCount count_unstable_poles(const SampledLoop& loop, const LoopGrid& grid);  ///< along a grid of its own

}  // namespace tunewright
