// The check of one leaf, over intervals: what it proves holds with rounding.
#pragma once

#include <vector>

#include "engine/certificate/axis.h"
#include "engine/certificate/box_bounds.h"
#include "engine/certificate/sign_mean.h"

namespace tunewright::certificate {

class LeafCheck {
public:
    LeafCheck(const CertificateProblem& problem, double w0, int harmonics, const std::vector<double>& edges);

    void add(const SignFunction& sign);
    /// The coefficients of a sign function's mean, as doubles, for the search.
    std::vector<double> coefficients(int phi) const;

    /// A lower bound of the IAE of every controller of the leaf's box that is stable and within the limits: infinite if
    /// there is none, 0 if the leaf proves nothing.
    double proven_bound(const CertificateLeaf& leaf) const;

    const SignFunction& sign(int phi) const { return signs_[static_cast<std::size_t>(phi)]; }
    int signs() const { return static_cast<int>(signs_.size()); }

private:
    using Row = HalfPlane<Interval>;
    PointOf<Interval> on_axis(double omega) const;
    /// The sum of the cuts' half-planes, times their multipliers; empty if one of them does not exist.
    bool sum_of_cuts(const CertificateLeaf& leaf, const GainsOf<Interval>& box, Row& sum) const;
    double bound_by_phi(const CertificateLeaf& leaf, const GainsOf<Interval>& box) const;

    const CertificateProblem& problem_;
    std::vector<PointOf<Interval>> harmonic_;
    std::vector<Interval> jackson_;
    std::vector<AxisPiece<Interval>> pieces_;
    std::vector<double> edges_;
    std::vector<SignFunction> signs_;
    std::vector<std::vector<Interval>> coefficients_;
};

}  // namespace tunewright::certificate
