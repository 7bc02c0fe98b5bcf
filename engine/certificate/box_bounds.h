// What one point s says about a whole box of controllers (docs/proof.md, B and C). Each function is an inequality that
// holds with rounding over intervals; over doubles it guides the search.
#pragma once

#include "engine/certificate/loop_terms.h"

namespace tunewright::certificate {

/// |S| <= Ms is |D| >= |Q|/Ms; |T| <= Mt is |D + Q/(Mt^2 - 1)| >= |Q| Mt/(Mt^2 - 1). Both: outside a disc.
template <class R>
struct ForbiddenDisc {
    ComplexOf<R> shift;  ///< minus the disc's centre
    R radius{};
};

template <class R>
ForbiddenDisc<R> forbidden_disc(const CertificateProblem& problem, const PointOf<R>& at, bool complementary) {
    const R Q = size(at.Q);
    if (!complementary) return {{}, Q / R(problem.Ms)};
    const R excess = square(R(problem.Mt)) - R(1);
    return {at.Q * (R(1) / excess), Q * (R(problem.Mt) / excess)};
}

template <class R>
bool exceeds_limit(const TermsOf<R>& terms, const ForbiddenDisc<R>& disc) {
    return largest_size(terms, disc.shift) < low(disc.radius);
}

/// A lower bound of |1/D|, and so of the IAE.
template <class R>
double error_bound(const TermsOf<R>& terms) {
    return low(R(1) / R(largest_size(terms, ComplexOf<R>{})));
}

/// sum_i row_i d_i >= least for every controller of the box within the limit.
template <class R>
struct HalfPlane {
    std::array<R, 3> row{};
    R least{};
    bool exists = false;
};

/// With z = D + shift, n = z_c/|z_c|, v >= |Im(conj(n) z)| and Re(conj(n) z) > 0 over the box: |z| >= radius demands
/// Re(conj(n) z) >= sqrt(radius^2 - v^2).
template <class R>
HalfPlane<R> half_plane(const TermsOf<R>& terms, const ForbiddenDisc<R>& disc) {
    HalfPlane<R> plane;
    const ComplexOf<R> z = terms.centre + disc.shift;
    const R far = size(z), inverse = R(1) / far;
    const ComplexOf<R> n = z * inverse;
    R reach = terms.rest, aside = terms.rest;
    for (std::size_t i = 0; i < 3; ++i) {
        plane.row[i] = along(n, terms.g[i]);
        reach = reach + size(plane.row[i]);
        aside = aside + size(across(n, terms.g[i]));
    }
    if (!(low(far) > high(reach)) || !(low(disc.radius) > high(aside))) return plane;
    plane.least = root(square(disc.radius) - square(aside)) - far - terms.rest;
    plane.exists = true;
    return plane;
}

/// Re(1/D) = value + sum_i slope_i d_i + remainder, |remainder| <= rest.
template <class R>
struct Harmonic {
    R value{}, rest{};
    std::array<R, 3> slope{};
    bool exists = false;
};

template <class R>
Harmonic<R> harmonic_of(const TermsOf<R>& terms) {
    Harmonic<R> harmonic;
    const R radius = radius_of(terms), squared = norm(terms.centre), far = root(squared);
    if (!(low(far - radius) > 0)) return harmonic;
    const ComplexOf<R> inverse = reciprocal(terms.centre), second = inverse * inverse;
    harmonic.value = inverse.re;
    for (std::size_t i = 0; i < 3; ++i) harmonic.slope[i] = -(second * terms.g[i]).re;
    harmonic.rest = (square(radius) / (far - radius) + terms.rest) / squared;
    harmonic.exists = true;
    return harmonic;
}

}  // namespace tunewright::certificate
