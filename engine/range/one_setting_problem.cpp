#include "engine/range/one_setting_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright::range {
namespace {

using robust::DesignPoint;

constexpr double kNoTd = -std::numeric_limits<double>::infinity();  // its logarithm
constexpr double kFirstStep = 0.4;                                  // of each logarithm
constexpr double kUnbounded = 700;                                  // of a logarithm: near that of the largest double

}  // namespace

JointProblem one_setting_problem(const std::vector<PointDesign*>& points, const RangeOptions& options, bool PI) {
    JointProblem joint;
    joint.places.assign(points.begin(), points.end());
    joint.aim = options.aim;
    const Eigen::Index n = PI ? 2 : points.front()->problem().dimension();
    joint.settings = [n, PI](const Eigen::VectorXd& v, double, SettingsSlope* slope) {
        if (slope != nullptr) slope->setIdentity(3, n);
        return DesignPoint{v[0], v[1], n > 2 ? v[2] : PI ? kNoTd : 0};
    };
    double fastest = 0, slowest = std::numeric_limits<double>::infinity();
    for (const PointDesign* place : points) {
        fastest = std::max(fastest, place->sweep().reference());
        slowest = std::min(slowest, place->sweep().reference());
    }
    joint.low = Eigen::VectorXd::Constant(n, -kUnbounded);
    joint.high = Eigen::VectorXd::Constant(n, kUnbounded);
    joint.step = Eigen::VectorXd::Constant(n, kFirstStep);
    joint.low[1] = std::log(robust::kMinTi / fastest);
    if (n > 2) joint.low[2] = std::log(robust::kMinTd / fastest);
    if (n > 2) joint.high[2] = std::log(robust::kMaxTd / slowest);
    return joint;
}

Eigen::VectorXd unknowns_of(const JointProblem& joint, const DesignPoint& x) {
    Eigen::VectorXd v(joint.low.size());
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = x[std::size_t(i)];
    if (v.size() > 2) v[2] = std::max(v[2], joint.low[2]);
    return v;
}

}  // namespace tunewright::range
