// The whole imaginary axis in intervals, for boxes of controllers that are all unstable (docs/proof.md, U).
//
// If |D| >= m > 0 for all controllers of the box on the axis and beyond a large circle, no pole enters or leaves the
// right half-plane, so all are stable or none. If the centre were stable, 1/D would be analytic there and by the
// maximum principle at most 1/m: |D(s0)| < m at one s0 with Re s0 > 0 shows that none is.
#pragma once

#include <complex>
#include <vector>

#include "engine/certificate/loop_terms.h"

namespace tunewright::certificate {

/// An interval of frequency, centre +- half.
template <class R>
struct AxisPiece {
    PointOf<R> point;  ///< at its centre
    R centre{}, half{};
    R radius_of_Q{};  ///< |Q(jw) - Q(j centre)| is at most this; not finite at a zero of P
};

/// `centre` and `half` as doubles: neighbours must overlap or meet.
template <class R>
AxisPiece<R> axis_piece(const CertificateProblem& problem, double centre, double half);

/// A lower bound of |D| over box and piece; may be negative.
template <class R>
double least_size(const CertificateProblem& problem, const GainsOf<R>& box, const AxisPiece<R>& piece,
                  const TermsOf<R>& terms);

/// A lower bound of |D| over the box for all |s| >= w, Re s >= 0; 0 if the plant does not dominate there.
template <class R>
double least_size_beyond(const CertificateProblem& problem, const GainsOf<R>& box, double w);

/// Frequencies, ascending, that bound the pieces: 0 first.
std::vector<double> axis_edges(double scale);

/// True if the box is unstable, by all pieces up to the first edge beyond which the plant dominates.
bool is_unstable_box(const CertificateProblem& problem, const CertifiedBox& box, std::complex<double> s0,
                     const std::vector<AxisPiece<Interval>>& pieces, const std::vector<double>& edges);

}  // namespace tunewright::certificate
