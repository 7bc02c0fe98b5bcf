// A block diagram in state space: linear equations with several delayed signals.
//
//   z' = F z + G v + H w,   x = M z + N v + R w,   v_k(t) = x_{from k}(t - L_k)
//
// x are the diagram's signals, w what enters at them from outside, z the states of the blocks.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/blocks/block_diagram.h"

namespace tunewright {

struct DiagramSystem {
    struct Delayed {
        int from = 0;
        double L = 0;  ///< > 0
    };
    std::vector<Delayed> delayed;  ///< each pair of signal and dead time once
    Eigen::MatrixXd F, G, H, M, N, R;

    Eigen::Index states() const { return F.rows(); }
    Eigen::Index signals() const { return M.rows(); }
};

/// Error: invalid_argument for an algebraic loop without a solution.
Expected<DiagramSystem> make_system(const BlockDiagram& diagram);

}  // namespace tunewright
