#include "engine/blocks/diagram_system.h"

#include <Eigen/LU>
#include <algorithm>

namespace tunewright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kSingular = 1e-12;  // reciprocal condition of the algebraic loops

/// The place of a delayed signal in the list, added if it is new.
Index place_of(std::vector<DiagramSystem::Delayed>& delayed, int from, double L) {
    const auto known = std::ranges::find_if(delayed, [&](const auto& one) { return one.from == from && one.L == L; });
    if (known != delayed.end()) return known - delayed.begin();
    delayed.push_back({from, L});
    return Index(delayed.size()) - 1;
}

}  // namespace

Expected<DiagramSystem> make_system(const BlockDiagram& diagram) {
    DiagramSystem out;
    std::vector<Index> place;  // of each block's input among the delayed signals
    Index n = 0;
    for (const Block& block : diagram.blocks()) {
        const double L = block.plant.dead_time();
        place.push_back(L > 0 ? place_of(out.delayed, block.from, L) : -1);
        n += block.plant.realisation().n;
    }
    const Index signals = diagram.signals(), count = Index(out.delayed.size());
    // z' = A z + B0 x + B1 v,   x = C z + D0 x + D1 v + w
    MatrixXd A = MatrixXd::Zero(n, n), B0 = MatrixXd::Zero(n, signals), B1 = MatrixXd::Zero(n, count);
    MatrixXd C = MatrixXd::Zero(signals, n), D0 = MatrixXd::Zero(signals, signals), D1 = MatrixXd::Zero(signals, count);
    Index at = 0;
    for (std::size_t b = 0; b < place.size(); ++b) {
        const Block& block = diagram.blocks()[b];
        const Realisation& own = block.plant.realisation();
        MatrixXd& B = place[b] < 0 ? B0 : B1;
        MatrixXd& D = place[b] < 0 ? D0 : D1;
        const Index input = place[b] < 0 ? block.from : place[b];
        A.block(at, at, own.n, own.n) = Eigen::Map<const RowMajor>(own.A.data(), own.n, own.n);
        B.col(input).segment(at, own.n) = Eigen::Map<const Eigen::VectorXd>(own.B.data(), own.n);
        C.row(block.to).segment(at, own.n) += Eigen::Map<const Eigen::RowVectorXd>(own.C.data(), own.n);
        D(block.to, input) += own.D;
        at += own.n;
    }
    const Eigen::FullPivLU<MatrixXd> loops(MatrixXd::Identity(signals, signals) - D0);
    if (!(loops.rcond() > kSingular))
        return Error{ErrorKind::invalid_argument, "",
                     "The loops have an algebraic loop without a solution: the direct gains around it are 1."};
    out.R = loops.inverse();
    out.M = out.R * C;
    out.N = out.R * D1;
    out.F = A + B0 * out.M;
    out.G = B1 + B0 * out.N;
    out.H = B0 * out.R;
    return out;
}

}  // namespace tunewright
