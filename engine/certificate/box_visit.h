// One box of the branch and bound, in doubles: tries the reasons to close it, cheap ones first.
//
// 1. 1/ki, and the frequency that came nearest for the parent.
// 2. All frequencies: forbidden discs, and |1/D| on the axis.
// 3. |1/D| in the right half-plane; Newton's method for a pole of the centre there, from a grid and else from the
//    rightmost pole of an unstable centre, then |1/D| at it and the whole axis.
// 4. If no such pole is found: the harmonics of each sign function, and the linear program with the limits'
// half-planes.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/certificate/leaf_check.h"
#include "engine/certificate/small_program.h"

namespace tunewright::certificate {

/// What the search knows of the problem, computed once.
struct SearchData {
    CertificateProblem problem;
    const LinearPlant* plant = nullptr;  ///< the same; not owned
    double goal = 0, scale = 0;          ///< scale: a frequency near the loop's peak
    std::vector<double> edges;
    std::vector<AxisPiece<double>> pieces;
    std::vector<ForbiddenDisc<double>> discs;  ///< of S and T, by turns
    std::vector<PointOf<double>> right;        ///< a grid of the right half-plane
    std::vector<PointOf<double>> harmonic;
    std::vector<std::vector<double>> phis;

    SearchData(const CertificateProblem& of, const LinearPlant& plant, double goal, double scale, double w0,
               int harmonics);
    int unknowns() const { return problem.structure == CertifiedStructure::pi ? 2 : 3; }
};

struct BoxOutcome {
    bool closed = false;
    CertificateLeaf leaf;    ///< the reason; of an open box its best bound
    double bound = 0;        ///< of an open box
    int hint = -1;           ///< the frequency that came nearest
    int axis = 0;            ///< the unknown to split
    bool wants_phi = false;  ///< a sign function of the centre may close it
};

/// Arrays of one visit, to be used again.
struct VisitSpace {
    std::vector<TermsOf<double>> axis;
    std::vector<Harmonic<double>> harmonic;
    std::vector<ProgramRow> rows;
    std::vector<LimitCut> cuts;
};

BoxOutcome visit_box(const SearchData& data, const LeafCheck& check, const CertifiedBox& box, int hint,
                     VisitSpace& space);

}  // namespace tunewright::certificate
