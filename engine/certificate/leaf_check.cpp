#include "engine/certificate/leaf_check.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace tunewright::certificate {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

}  // namespace

LeafCheck::LeafCheck(const CertificateProblem& problem, double w0, int harmonics, const std::vector<double>& edges)
    : problem_(problem), jackson_(jackson_factors(harmonics)), edges_(edges) {
    for (int m = 0; m < harmonics; ++m)
        harmonic_.push_back(point_at(problem, ComplexOf<Interval>{0.0, Interval(m) * Interval(w0)}));
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const double centre = 0.5 * (edges[i] + edges[i + 1]);
        const Interval half = larger(Interval(edges[i + 1]) - Interval(centre), Interval(centre) - Interval(edges[i]));
        pieces_.push_back(axis_piece<Interval>(problem, centre, half.high()));
    }
}

void LeafCheck::add(const SignFunction& sign) {
    signs_.push_back(sign);
    coefficients_.push_back(mean_coefficients(sign, jackson_));
}

std::vector<double> LeafCheck::coefficients(int phi) const {
    std::vector<double> middle;
    for (const Interval a : coefficients_[static_cast<std::size_t>(phi)]) middle.push_back(0.5 * (a.low() + a.high()));
    return middle;
}

PointOf<Interval> LeafCheck::on_axis(double omega) const { return point_at(problem_, ComplexOf<Interval>{0.0, omega}); }

bool LeafCheck::sum_of_cuts(const CertificateLeaf& leaf, const GainsOf<Interval>& box, Row& sum) const {
    for (const LimitCut& cut : leaf.cuts) {
        if (!(cut.multiplier >= 0) || !(cut.omega > 0)) return false;
        const auto point = on_axis(cut.omega);
        const auto plane =
            half_plane(terms_at(problem_.structure, box, point), forbidden_disc(problem_, point, cut.complementary));
        if (!plane.exists) return false;
        for (std::size_t i = 0; i < 3; ++i) sum.row[i] = sum.row[i] + plane.row[i] * Interval(cut.multiplier);
        sum.least = sum.least + plane.least * Interval(cut.multiplier);
    }
    return true;
}

double LeafCheck::bound_by_phi(const CertificateLeaf& leaf, const GainsOf<Interval>& box) const {
    const auto& a = coefficients_[static_cast<std::size_t>(leaf.phi)];
    Interval bound(0);
    std::array<Interval, 3> slope{};
    for (std::size_t m = 0; m < a.size(); ++m) {
        const auto harmonic = harmonic_of(terms_at(problem_.structure, box, harmonic_[m]));
        if (!harmonic.exists) return 0;
        bound = bound + a[m] * harmonic.value - size(a[m]) * harmonic.rest;
        for (std::size_t i = 0; i < 3; ++i) slope[i] = slope[i] + a[m] * harmonic.slope[i];
    }
    Row cuts;
    if (!sum_of_cuts(leaf, box, cuts)) return 0;
    // slope d >= cuts.least + (slope - cuts.row) d for every d that the cuts leave.
    bound = bound + cuts.least;
    for (std::size_t i = 0; i < 3; ++i) bound = bound - size(slope[i] - cuts.row[i]);
    return std::isfinite(bound.low()) ? bound.low() : 0;
}

double LeafCheck::proven_bound(const CertificateLeaf& leaf) const {
    const GainsOf<Interval> box(leaf.box);
    switch (leaf.reason) {
        case LeafReason::sensitivity:
        case LeafReason::complementary: {
            if (!(leaf.omega > 0)) return 0;
            const auto point = on_axis(leaf.omega);
            const auto disc = forbidden_disc(problem_, point, leaf.reason == LeafReason::complementary);
            return exceeds_limit(terms_at(problem_.structure, box, point), disc) ? kNone : 0;
        }
        case LeafReason::error: {
            if (!(leaf.s.real() >= 0)) return 0;
            const auto point = point_at(problem_, ComplexOf<Interval>{leaf.s.real(), leaf.s.imag()});
            const double bound = error_bound(terms_at(problem_.structure, box, point));
            return std::isfinite(bound) ? bound : 0;
        }
        case LeafReason::bound: return bound_by_phi(leaf, box);
        case LeafReason::empty: {
            Row cuts;
            if (!sum_of_cuts(leaf, box, cuts)) return 0;
            Interval most(0);
            for (const Interval& x : cuts.row) most = most + size(x);
            return low(cuts.least - most) > 0 ? kNone : 0;
        }
        case LeafReason::unstable: return is_unstable_box(problem_, leaf.box, leaf.s, pieces_, edges_) ? kNone : 0;
    }
    return 0;
}

}  // namespace tunewright::certificate
