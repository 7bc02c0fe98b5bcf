#include "engine/loop/delay_system.h"

#include <Eigen/Core>

#include "engine/loop/loop_builder.h"

namespace tunewright {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<Vector> mapped(std::vector<double>& values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}
Eigen::Map<const Vector> mapped(const std::vector<double>& values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

DelaySystem make_delay_system(const LinearPlant& plant, const ParallelPid& controller) {
    return LoopBuilder(plant.realisation(), plant.dead_time(), controller).build();
}

DelaySystem close_without_delay(const DelaySystem& open) {
    // v = u + d and u = M x + N v + R r give v = (M x + R r + d)/(1 - N).
    DelaySystem closed = open;
    const double g = 1 / (1 - open.N);
    const auto G = mapped(open.G), M = mapped(open.M);
    Eigen::Map<Matrix>(closed.F.data(), open.n, open.n).noalias() += (g * G) * M.transpose();
    mapped(closed.H) += (g * open.R) * G;
    mapped(closed.G) *= g;
    mapped(closed.M) *= g;
    mapped(closed.Y) += (open.Z * g) * M;
    closed.R = open.R * g;
    closed.N = open.N * g;
    closed.Z = open.Z * g;
    closed.Y_r = open.Z * g * open.R;
    return closed;
}

}  // namespace tunewright
