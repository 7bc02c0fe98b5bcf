// The loops of a sweep over a curve's grid: with thousands of controllers and hundreds of frequencies each they take
// most of a design's time. Each is compiled for the registers that every amd64 processor has and, where the processor
// has them, for those of AVX2. Both give identical results: the same operations in the same order, none of them fused.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/numerics/registers.h"

namespace tunewright::robust {

/// A curve's frequencies and P there; all of one length.
struct CurveGrid {
    std::span<const double> omega, P_re, P_im;

    std::size_t size() const { return omega.size(); }
    CurveGrid part(std::size_t from, std::size_t to) const {
        return {omega.subspan(from, to - from), P_re.subspan(from, to - from), P_im.subspan(from, to - from)};
    }
};

/// C = (Kp + Ki/s + Kd s)/(1 + Tf s + Tf^2 s^2/2).
struct LoopGains {
    double Kp, Ki, Kd, Tf;
};

std::complex<double> controller_response(const LoopGains& gains, double omega);

/// 1/limit^2, which scales squared peaks to 1 at their limits; 0 disables a constraint.
struct InverseLimits {
    double S, T, CS;
};

/// A circle with its centre on the real axis.
struct Circle {
    double centre, radius;
};

/// If the dead time turns faster than the grid resolves, the loop's worst phase is assumed: L = -|L|.
enum class Phase { as_it_is, worst };

/// |S|^2, |T|^2 and, unless `CS` is null, |C S|^2 over their limits' squares.
void peak_levels(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits, double* S, double* T,
                 double* CS, Registers registers = widest_registers());

/// Distance of L from -1 if the dead time takes every phase and |L| >= 1: gives values far beyond any limit.
constexpr double kMinDistance = 1e-6;

/// The same at the worst phase: 1 - |L| takes the place of |1 + L|.
void turning_levels(const CurveGrid& grid, const LoopGains& gains, const InverseLimits& limits, double* S, double* T,
                    double* CS, Registers registers = widest_registers());

/// Indices at which a level is at least `from`, not lower than the one before and higher than the one after, in
/// ascending order.
void local_maxima(std::span<const double> level, double from, std::vector<std::size_t>& found,
                  Registers registers = widest_registers());

/// radius^2/|L - centre|^2.
void circle_levels(const CurveGrid& grid, const LoopGains& gains, const Circle& circle, double* level,
                   Registers registers = widest_registers());

/// L.
void open_loops(const CurveGrid& grid, const LoopGains& gains, Phase phase, double* L_re, double* L_im,
                Registers registers = widest_registers());

/// Intervals of factors, one for each frequency; upper <= 0 if there is none. Lower ends may be negative.
struct Intervals {
    std::span<double> lower, upper;
};

/// The factors k > 0 for which k L lies inside one of the circles. `first` has the interval of either circle, or the
/// union if they overlap; `second` has that of b if it does not overlap that of a.
void forbidden_factors(std::span<const double> L_re, std::span<const double> L_im, const Circle& a, const Circle& b,
                       Intervals first, Intervals second, Registers registers = widest_registers());

/// True if |L_to - L_from| < most |1 + L_from| at every frequency. At the worst phase 1 - |L_from| takes the place of
/// |1 + L_from|, and must be positive.
bool moves_less(const CurveGrid& grid, const LoopGains& from, const LoopGains& to, double max, Phase phase,
                Registers registers = widest_registers());

}  // namespace tunewright::robust
