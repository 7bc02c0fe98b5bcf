// Stability of the closed loop, by the argument principle on the characteristic function, with the exact dead time.
#pragma once

#include "engine/loop/loop.h"

namespace tunewright {

/// Closed-loop poles in the right half-plane, counted by the change of argument of D + N e^(-sL) along the imaginary
/// axis (Mikhailov's form of the Nyquist criterion: integrators and undamped open-loop poles need no indentation).
struct StabilityCount {
    int unstable_poles = 0;        ///< -1: infinitely many (a neutral loop with |L(infinity)| >= 1)
    bool on_the_boundary = false;  ///< a pole on the imaginary axis, to working precision
    bool stable() const { return unstable_poles == 0 && !on_the_boundary; }
};

/// Costs about a hundred evaluations of the loop. If the dead time turns L outside the unit circle far more often than
/// the plant's states can undo, the number of unstable poles is an estimate, but it is certainly not 0.
StabilityCount count_unstable_poles(const Loop& loop);

/// The second, independent method: the rightmost closed-loop pole from a Chebyshev discretisation of the delay operator
/// (Breda, Maset, Vermiglio 2005) with `nodes` >= 1 points over the dead time, in rad/time. Poles with |s| L up to
/// about nodes/2 are accurate; without dead time `nodes` is not used. The cost is that of the eigenvalues of a matrix
/// as large as the loop's states and the nodes together. Of a complex pair the result is the member with the positive
/// imaginary part. Error: numerical_failure for a loop without states or without finite realisation.
Expected<std::complex<double>> rightmost_pole(const Loop& loop, int nodes = 16);

}  // namespace tunewright
