// Stability of loops that are closed together, by two methods.
#pragma once

#include <complex>

#include "engine/blocks/block_diagram.h"
#include "engine/loop/stability.h"

namespace tunewright {

/// Zeros of the characteristic function in the right half-plane, counted by its change of argument along the imaginary
/// axis (Mikhailov's criterion), dead times exact. With `right_of` only those whose real part exceeds it, in units of
/// 1/time_scale(): a controller by itself has poles at 0.
StabilityCount count_unstable_poles(const BlockDiagram& diagram, double right_of = 0);

/// The second, independent method: the rightmost pole of a Chebyshev discretisation of each delayed signal (Breda,
/// Maset and Vermiglio 2005) with `nodes` >= 1 points, moved to the zero of the characteristic function by Newton's
/// method. Error: numerical_failure for a diagram without states.
Expected<std::complex<double>> rightmost_pole(const BlockDiagram& diagram, int nodes = 16);

}  // namespace tunewright
