// Plant and controller together over frequency.
//
//        r --> [ C ] --> u --(+)--> [ P ] --> y        L = P C, S = 1/(1 + L), T = L/(1 + L), C S
//               ^             ^ d              |       C = -u/y with r = 0: the filter belongs to it,
//               +------------- y --------------+       the set-point weights do not
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// The loop's transfer functions at one frequency. Finite also at undamped poles and at 0, because S = D/(D + N).
struct LoopPoint {
    std::complex<double> L, S, T, CS;
};

/// Points along a loop, omega ascending.
struct LoopGrid {
    std::vector<double> omega;
    std::vector<LoopPoint> point;  ///< the loop at each omega
    double resolved_to = 0;  ///< above it the dead time turns L faster than the grid follows; |L| is still followed
};

/// Errors of a controller that is wrong for every plant: numbers that are not finite, Tf <= 0 with a filter, all gains
/// 0, a derivative of r without filter.
std::optional<Error> check_controller(const ParallelPid& gains);

/// C(s) of the filtered controller, without set-point weights.
std::complex<double> controller_response(const ParallelPid& gains, std::complex<double> s);

class Loop {
public:
    /// Errors: invalid_argument ("controller") if no loop exists: a derivative without filter on a plant of pole excess
    /// 0, 1 + L(infinity) = 0 without dead time, gains or filter that are not finite, Tf <= 0 with a filter, all gains
    /// 0.
    static Expected<Loop> make(const LinearPlant& plant, const ParallelPid& gains);

    LoopPoint at(double omega) const;
    /// At many frequencies, several times as fast; each value agrees to 1e-12.
    std::vector<LoopPoint> at(std::span<const double> omega) const;
    /// At 0 and, with a dead time at its worst phase, at infinity; |C S| is left out at 0 where it is infinite.
    LoopGrid ends() const;
    double turning_time() const { return plant_->dead_time(); }
    std::complex<double> controller(std::complex<double> s) const;
    std::complex<double> open_loop(std::complex<double> s) const;

    /// L = numerator e^(-sL)/denominator with numerator and denominator finite everywhere; the characteristic function
    /// is their sum.
    struct Fraction {
        std::complex<double> numerator, denominator;
    };
    Fraction fraction(std::complex<double> s) const;  ///< dead time included in the numerator
    int denominator_degree() const;

    /// q = |L(infinity)| without the dead time's turning; 0 for a strictly proper loop. With dead time q >= 1 is
    /// unstable.
    double high_frequency_gain() const;
    double signed_high_frequency_gain() const;
    /// C(infinity) of the filtered controller; infinite for a derivative without filter.
    double controller_high_frequency_gain() const;

    const LinearPlant& plant() const { return *plant_; }
    const ParallelPid& gains() const { return gains_; }

private:
    /// Controller and plant, each as a fraction.
    struct Parts {
        std::complex<double> controller_numerator, controller_denominator, plant_numerator, plant_denominator;
    };
    Parts parts(std::complex<double> s) const;
    /// Evaluates at two neighbouring frequencies; false if it cannot, and then nothing is written.
    bool pair_at(const double* omega, LoopPoint* to) const;

    Loop(const LinearPlant& plant, const ParallelPid& gains) : plant_(&plant), gains_(gains) {}
    int controller_excess() const;                  // degree of denominator minus numerator
    double controller_leading_coefficient() const;  // ratio of the leading coefficients of numerator and denominator

    const LinearPlant* plant_;
    ParallelPid gains_;
};

}  // namespace tunewright
