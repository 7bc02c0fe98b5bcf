// Stability of a loop whose integral acts on less than the error: on k(e) e with k(e) in (0, 1].
//
//   r = 0:   e = -y,   y = G(s) phi(e),   G = (Ki/s) P/(1 + P C_PD),   0 < phi(e)/e <= 1
#pragma once

#include <optional>

#include "engine/loop/loop.h"

namespace tunewright {

struct IntegralSector {
    bool stable_without_integral = false;  ///< the loop of P and D action alone, the limit for large errors
    bool circle_criterion = false;         ///< Re G(j omega) > -1 everywhere
    bool popov_criterion = false;          ///< Re (1 + j omega q) G(j omega) > -1 everywhere
    std::optional<double> popov_q;         ///< a q >= 0 that satisfies the condition; 0 if the circle criterion holds
    /// The largest factor below 1 of the integral gain at which the loop oscillates, and the frequency of that
    /// oscillation; empty if none.
    std::optional<double> critical_gain, critical_omega;

    /// Every error decays, whatever its size.
    bool absolutely_stable() const { return circle_criterion || popov_criterion; }
    /// The linear loop is stable for every factor in (0, 1]: the describing function predicts no oscillation.
    bool stable_for_every_gain = false;
};

/// For a stable loop with integral action. Both criteria need `stable_without_integral` and a positive residue of G at
/// 0; they are sufficient for phi in the sector (0, 1], time-invariant for Popov's. They are checked on a grid, refined
/// at the minima; where the grid does not resolve the dead time, a bound on |G| is used. Sources: Popov, Automation and
/// Remote Control 22 (1961) 857-875; Zames, IEEE Trans. Automatic Control 11 (1966) 465-476; with dead time: Desoer &
/// Vidyasagar, Feedback Systems: Input-Output Properties (1975).
IntegralSector judge_integral_sector(const Loop& loop);

}  // namespace tunewright
