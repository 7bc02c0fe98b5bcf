// Derivatives of a nonlinear plant's output along its motion, exact by Taylor arithmetic along the flow: L_f^k h, and
// L_g L_f^(r-1) h by one additional dual direction in u.
//
// Source: Isidori, Nonlinear Control Systems, 2nd ed. 1989, section 4.1; Mhaskar, El-Farra & Christofides (2004), Eqs.
// 5-6.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// The order of the first derivative of y that u enters, found on the exact derivatives at and around the operating
/// point. Errors, unsupported with `where` = "plant/...": f is not affine in u (names the equation); u enters no
/// derivative up to the order n; the coefficient of u in that derivative is 0 at the operating point only (the relative
/// degree is undefined there).
Expected<int> relative_degree(const NonlinearSystem& system);

struct LieDerivatives {
    std::vector<double> of_f;  ///< L_f^k h for k = 0 to r; of_f[0] = h(x), absolute
    double of_g = 0;           ///< L_g L_f^(r-1) h: y^(r) = of_f[r] + of_g u, u absolute
};

/// Evaluates them at x, for the relative degree r. False if they are not finite.
bool lie_derivatives(const NonlinearSystem& system, int r, std::span<const double> x, LieDerivatives& out);

/// Zeros of the linearisation: the poles of the zero dynamics at the operating point.
struct ZeroDynamics {
    std::vector<std::complex<double>> zeros;
    bool stable = true;  ///< true: all in the open left half-plane
};
ZeroDynamics zero_dynamics(const NonlinearSystem& system);

}  // namespace tunewright
