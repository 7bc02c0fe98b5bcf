// D(s) = s/P(s) + s C(s) at one s over a box of controllers: a centre, one complex vector for each half-width, and a
// radius for what these leave.
//
//   D = centre + sum d_i g_i + rho,  |d_i| <= 1,  |rho| <= rest
//
// With a fixed filter D is affine and rest = 0. With the tied one, y = s Td/N, N = 10, p(y) = 1 + y + y^2/2:
//
//   D = s/P + s k a(y) + ki b(y),     b = 1/p,             b' = -(1 + y)/p^2,          b'' = (1 + 3y + 3/2 y^2)/p^3,
//   a = (1 + N y)/p,   a' = (9 - y - 5 y^2)/p^2,   a'' = (-19 - 27 y + 3/2 y^2 + 5 y^3)/p^3
//
// and the rest is that of Taylor's series. Along a ray y = t e^(j alpha) with |alpha| <= pi/2
// |p|^2 = 1 + 2 t cos(alpha) + 2 t^2 cos(alpha)^2 + t^3 cos(alpha) + t^4/4 ascends with t, so 1/|p| is largest at the
// least Td; the numerators are bounded by their own Taylor series around the centre, which end.
#pragma once

#include <array>

#include "engine/certificate/certificate.h"
#include "engine/certificate/complex_of.h"

namespace tunewright::certificate {

inline constexpr double kN = 10;  ///< Td/Tf of the tied filter

/// A box as centre and half-widths.
template <class R>
struct GainsOf {
    std::array<R, 3> c{}, h{};

    explicit GainsOf(const CertifiedBox& box) {
        for (std::size_t i = 0; i < 3; ++i) {
            c[i] = (R(box.low[i]) + R(box.high[i])) * R(0.5);
            h[i] = (R(box.high[i]) - R(box.low[i])) * R(0.5);
        }
    }
};

/// s with what the plant and a fixed filter have there.
template <class R>
struct PointOf {
    ComplexOf<R> s, Q;  ///< Q = s/P(s)
    ComplexOf<R> F;     ///< of a fixed filter
};

template <class R>
struct TermsOf {
    ComplexOf<R> centre;
    std::array<ComplexOf<R>, 3> g{};
    R rest{};
};

template <class R>
ComplexOf<R> filter_polynomial(ComplexOf<R> y) {
    return {R(1) + y.re + (square(y.re) - square(y.im)) * R(0.5), y.im + y.re * y.im};
}

template <class R>
ComplexOf<R> polynomial(const std::vector<double>& descending, ComplexOf<R> s) {
    ComplexOf<R> value{};
    for (const double a : descending) {
        value = value * s;
        value.re = value.re + R(a);
    }
    return value;
}

template <class R>
PointOf<R> point_at(const CertificateProblem& problem, ComplexOf<R> s) {
    PointOf<R> point;
    point.s = s;
    const R L(problem.plant.L), grown = exponential(s.re * L), angle = s.im * L;
    const ComplexOf<R> delay{grown * cosine(angle), grown * sine(angle)};
    point.Q = s * polynomial(problem.plant.den, s) * reciprocal(polynomial(problem.plant.num, s)) * delay;
    point.F = reciprocal(filter_polynomial(s * R(problem.Tf)));
    return point;
}

/// a, b of the tied filter over an interval of Td, around its centre.
template <class R>
struct TiedFilter {
    ComplexOf<R> a, b, a1, b1;  ///< values and derivatives in y at the centre
    R rho{};                    ///< half-width of |y|
    R A1{}, B1{}, A2{}, B2{};   ///< radii without and with the linear term

    TiedFilter(ComplexOf<R> s, R T, R h) {
        const ComplexOf<R> y = s * (T / R(kN)), y2 = y * y, y3 = y2 * y;
        const ComplexOf<R> inverse = reciprocal(filter_polynomial(y)), squared = inverse * inverse;
        const auto sum = [](R constant, ComplexOf<R> z) { return ComplexOf<R>{constant + z.re, z.im}; };
        b = inverse;
        a = sum(R(1), y * R(kN)) * inverse;
        const ComplexOf<R> slope_of_a = sum(R(9), ComplexOf<R>{} - y - y2 * R(5)), slope_of_b = sum(R(1), y);
        a1 = slope_of_a * squared;
        b1 = ComplexOf<R>{} - slope_of_b * squared;
        rho = size(s) * h / R(kN);
        const R inverse_2 = R(1) / norm(filter_polynomial(s * ((T - h) / R(kN)))),
                inverse_3 = inverse_2 * root(inverse_2);
        const R rho_2 = square(rho);
        A1 = rho * inverse_2 * (size(slope_of_a) + size(sum(R(1), y * R(10))) * rho + rho_2 * R(5));
        B1 = rho * inverse_2 * (size(slope_of_b) + rho);
        const ComplexOf<R> bend = ComplexOf<R>{} - y * R(27) + y2 * R(1.5) + y3 * R(5);
        A2 = rho_2 * R(0.5) * inverse_3 *
             (size(sum(R(-19), bend)) + size(sum(R(-27), y * R(3) + y2 * R(15))) * rho +
              size(sum(R(1.5), y * R(15))) * rho_2 + rho_2 * rho * R(5));
        B2 = rho_2 * R(0.5) * inverse_3 *
             (size(sum(R(1), y * R(3) + y2 * R(1.5))) + size(sum(R(3), y * R(3))) * rho + rho_2 * R(1.5));
    }
};

template <class R>
TermsOf<R> tied_terms(const GainsOf<R>& box, const PointOf<R>& at) {
    const R k = box.c[0], ki = box.c[1], most_k = size(k) + box.h[0], most_ki = size(ki) + box.h[1], w = size(at.s);
    const TiedFilter<R> f(at.s, box.c[2], box.h[2]);
    TermsOf<R> terms;
    const ComplexOf<R> sa = at.s * f.a;
    terms.centre = at.Q + sa * k + f.b * ki;
    terms.g[0] = sa * box.h[0];
    terms.g[1] = f.b * box.h[1];
    terms.g[2] = (at.s * f.a1 * k + f.b1 * ki) * (at.s * (box.h[2] / R(kN)));
    terms.rest = w * (box.h[0] * f.A1 + size(k) * f.A2) + box.h[1] * f.B1 + size(ki) * f.B2;
    const R rough = w * most_k * f.A1 + most_ki * f.B1;
    if (high(rough) < high(terms.rest + size(terms.g[2]))) {
        terms.rest = rough;
        terms.g[2] = {};
    }
    return terms;
}

template <class R>
TermsOf<R> terms_at(CertifiedStructure structure, const GainsOf<R>& box, const PointOf<R>& at) {
    if (structure == CertifiedStructure::pid_tied) return tied_terms(box, at);
    TermsOf<R> terms;
    const ComplexOf<R> sF = at.s * at.F;
    terms.centre = at.Q + sF * box.c[0] + at.F * box.c[1];
    terms.g[0] = sF * box.h[0];
    terms.g[1] = at.F * box.h[1];
    if (structure == CertifiedStructure::pid_fixed) {
        const ComplexOf<R> ssF = at.s * sF;
        terms.centre = terms.centre + ssF * box.c[2];
        terms.g[2] = ssF * box.h[2];
    }
    return terms;
}

/// An upper bound of |D + shift| over the box: that of a corner.
template <class R>
double largest_size(const TermsOf<R>& terms, ComplexOf<R> shift) {
    const ComplexOf<R> z = terms.centre + shift, g = terms.g[0], u = terms.g[1] + terms.g[2],
                       v = terms.g[1] - terms.g[2];
    const double squared = std::max(std::max(std::max(high(norm(z + g + u)), high(norm(z + g - u))),
                                             std::max(high(norm(z + g + v)), high(norm(z + g - v)))),
                                    std::max(std::max(high(norm(z - g + u)), high(norm(z - g - u))),
                                             std::max(high(norm(z - g + v)), high(norm(z - g - v)))));
    return high(root(R(squared)) + terms.rest);
}

/// An upper bound of |sum d_i g_i + rho|.
template <class R>
R radius_of(const TermsOf<R>& terms) {
    const ComplexOf<R> g = terms.g[0], u = terms.g[1] + terms.g[2], v = terms.g[1] - terms.g[2];
    return root(larger(larger(norm(g + u), norm(g - u)), larger(norm(g + v), norm(g - v)))) + terms.rest;
}

}  // namespace tunewright::certificate
