// Complex numbers over doubles or over intervals. The search computes with the former, the check of a leaf with the
// latter, by the same formulas.
#pragma once

#include "engine/certificate/interval.h"

namespace tunewright::certificate {

template <class R>
struct ComplexOf {
    R re{}, im{};

    friend ComplexOf operator+(ComplexOf a, ComplexOf b) { return {a.re + b.re, a.im + b.im}; }
    friend ComplexOf operator-(ComplexOf a, ComplexOf b) { return {a.re - b.re, a.im - b.im}; }
    friend ComplexOf operator*(ComplexOf a, ComplexOf b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    friend ComplexOf operator*(ComplexOf a, R b) { return {a.re * b, a.im * b}; }
};

template <class R>
R norm(ComplexOf<R> z) {
    return square(z.re) + square(z.im);
}
template <class R>
R size(ComplexOf<R> z) {
    return root(norm(z));
}
template <class R>
ComplexOf<R> reciprocal(ComplexOf<R> z) {
    const R inverse = R(1) / norm(z);
    return {z.re * inverse, -(z.im * inverse)};
}
/// Re(conj(n) z).
template <class R>
R along(ComplexOf<R> n, ComplexOf<R> z) {
    return n.re * z.re + n.im * z.im;
}
/// Im(conj(n) z).
template <class R>
R across(ComplexOf<R> n, ComplexOf<R> z) {
    return n.re * z.im - n.im * z.re;
}

}  // namespace tunewright::certificate
