#include "engine/certificate/axis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunewright::certificate {
namespace {

/// A polynomial at the centre of a disc, and how far its values in the disc are from there: its Taylor series, which
/// ends.
template <class R>
struct PolynomialDisc {
    ComplexOf<R> value;
    R radius{};
};

template <class R>
PolynomialDisc<R> over_disc(const std::vector<double>& descending, ComplexOf<R> s, R half) {
    // Repeated synthetic division leaves the Taylor coefficients at s.
    std::vector<ComplexOf<R>> taylor;
    for (const double a : descending) taylor.push_back({R(a), R(0)});
    const std::size_t n = taylor.size();
    for (std::size_t done = 0; done + 1 < n; ++done)
        for (std::size_t i = 1; i + done < n; ++i) taylor[i] = taylor[i] + taylor[i - 1] * s;
    PolynomialDisc<R> disc{taylor[n - 1], R(0)};
    R power(1);
    for (std::size_t k = 1; k < n; ++k) {
        power = power * half;
        disc.radius = disc.radius + size(taylor[n - 1 - k]) * power;
    }
    return disc;
}

/// A bound of |d(sC)/ds| over the box and the frequencies from `first` to `last`.
template <class R>
R controller_slope(const CertificateProblem& problem, const GainsOf<R>& box, R first, R last) {
    const R k = size(box.c[0]) + box.h[0], ki = size(box.c[1]) + box.h[1], third = size(box.c[2]) + box.h[2];
    const auto least_polynomial = [](R v) { return R(1) + square(square(v)) * R(0.25); };  // |p(jv)|^2
    if (problem.structure == CertifiedStructure::pid_tied) {
        const R from = first * (box.c[2] - box.h[2]) / R(kN), to = last * third / R(kN);
        const R inverse = R(1) / least_polynomial(larger(from, R(0)));
        const R a = root(R(1) + square(to * R(kN))) * root(inverse);
        const R a1 = (root(square(R(9) + square(to) * R(5)) + square(to))) * inverse;
        const R b1 = root(R(1) + square(to)) * inverse;
        return k * a + (k * last * a1 + ki * b1) * (third / R(kN));
    }
    const R Tf(problem.Tf), inverse = R(1) / least_polynomial(first * Tf);
    const R law = k * last + ki + third * square(last), law_slope = k + third * last * R(2);
    return Tf * root(R(1) + square(last * Tf)) * inverse * law + root(inverse) * law_slope;
}

}  // namespace

template <class R>
AxisPiece<R> axis_piece(const CertificateProblem& problem, double centre, double half) {
    AxisPiece<R> piece;
    piece.centre = R(centre);
    piece.half = R(half);
    const ComplexOf<R> s{R(0), R(centre)};
    piece.point = point_at(problem, s);
    std::vector<double> s_den = problem.plant.den;
    s_den.push_back(0);
    const auto upper = over_disc(s_den, s, piece.half), lower = over_disc(problem.plant.num, s, piece.half);
    // |u e^(jwL)/n - u_c e^(jw_c L)/n_c|, with |e^(jwL) - e^(jw_c L)| <= half L.
    const R turned = upper.radius + size(upper.value) * piece.half * R(problem.plant.L);
    const R left = size(lower.value) - lower.radius;
    piece.radius_of_Q = low(left) > 0 ? (turned + size(piece.point.Q) * lower.radius) / left
                                      : R(std::numeric_limits<double>::infinity());
    return piece;
}

template <class R>
double least_size(const CertificateProblem& problem, const GainsOf<R>& box, const AxisPiece<R>& piece,
                  const TermsOf<R>& terms) {
    const R far = size(terms.centre), inverse = R(1) / far;
    const ComplexOf<R> n = terms.centre * inverse;
    R reach = terms.rest + piece.radius_of_Q;
    for (const ComplexOf<R>& g : terms.g) reach = reach + size(along(n, g));
    const R slope = controller_slope(problem, box, piece.centre - piece.half, piece.centre + piece.half);
    return low(far - reach - slope * piece.half);
}

template <class R>
double least_size_beyond(const CertificateProblem& problem, const GainsOf<R>& box, double w) {
    const auto &num = problem.plant.num, &den = problem.plant.den;
    const auto excess = static_cast<int>(den.size()) - static_cast<int>(num.size());
    R upper = R(std::abs(num[0])), lower = R(std::abs(den[0])), power(1);
    const R step = R(1) / R(w);
    for (std::size_t i = 1; i < den.size(); ++i) {
        power = power * step;
        lower = lower - R(std::abs(den[i])) * power;
        if (i < num.size()) upper = upper + R(std::abs(num[i])) * power;
    }
    const R ratio = lower / upper;  // |Q| >= ratio w^(1 + excess)
    if (!(low(ratio) > 0)) return 0;
    const R k = size(box.c[0]) + box.h[0], ki = size(box.c[1]) + box.h[1], third = size(box.c[2]) + box.h[2];
    // |F| <= 1 and <= 2/|y|^2. Each term over w^(1 + excess) does not ascend with w.
    R law = k * R(w) + ki;
    const bool grows = excess == 0;
    if (problem.structure == CertifiedStructure::pid_tied) {
        const R most(14.143);  // sqrt(2) N: of w Td min(1, 2 (N/(w Td))^2)
        law = law + k * R(w) * (grows ? most : smaller(R(w) * third, most));
    } else if (problem.structure == CertifiedStructure::pid_fixed) {
        const R filtered = problem.Tf > 0 ? R(2) / square(R(problem.Tf)) : R(std::numeric_limits<double>::infinity());
        law = law + third * (grows ? filtered : smaller(square(R(w)), filtered));
    }
    R plant = ratio * R(w);
    for (int i = 0; i < excess; ++i) plant = plant * R(w);
    return high(law + law) <= low(plant) ? low(plant) / 2 : 0;
}

std::vector<double> axis_edges(double scale) {
    constexpr int kPieces = 640;
    constexpr double kFirstDecade = -2.8, kLastDecade = 3.2;
    std::vector<double> edges = {0};
    for (int i = 0; i <= kPieces; ++i)
        edges.push_back(scale * std::pow(10.0, kFirstDecade + (kLastDecade - kFirstDecade) * i / kPieces));
    return edges;
}

bool is_unstable_box(const CertificateProblem& problem, const CertifiedBox& box, std::complex<double> s0,
                     const std::vector<AxisPiece<Interval>>& pieces, const std::vector<double>& edges) {
    if (!(s0.real() > 0)) return false;
    const GainsOf<Interval> gains(box);
    GainsOf<Interval> centre = gains;
    centre.h = {};
    const auto there =
        terms_at(problem.structure, centre, point_at(problem, ComplexOf<Interval>{s0.real(), s0.imag()}));
    const double needed = high(size(there.centre) + there.rest);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const auto terms = terms_at(problem.structure, gains, pieces[i].point);
        if (!(least_size(problem, gains, pieces[i], terms) > needed)) return false;
        if (least_size_beyond(problem, gains, edges[i + 1]) > needed) return true;
    }
    return false;
}

template AxisPiece<double> axis_piece(const CertificateProblem&, double, double);
template AxisPiece<Interval> axis_piece(const CertificateProblem&, double, double);
template double least_size(const CertificateProblem&, const GainsOf<double>&, const AxisPiece<double>&,
                           const TermsOf<double>&);
template double least_size(const CertificateProblem&, const GainsOf<Interval>&, const AxisPiece<Interval>&,
                           const TermsOf<Interval>&);
template double least_size_beyond(const CertificateProblem&, const GainsOf<double>&, double);
template double least_size_beyond(const CertificateProblem&, const GainsOf<Interval>&, double);

}  // namespace tunewright::certificate
