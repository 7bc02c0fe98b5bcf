#include "engine/range/search/minimax_program.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tunewright::range {
namespace {

constexpr int kMostIterations = 80;
constexpr double kExact = 1e-9;         // of residuals and of the complementarity
constexpr double kUsable = 1e-6;        // where rounding ends the iteration: still a step
constexpr double kShortOfWall = 0.995;  // of the way to the nearest slack or multiplier of 0

/// The longest step, at most 1, that keeps v + step dv above 0.
double longest_step(const Eigen::VectorXd& v, const Eigen::VectorXd& dv) {
    double step = 1;
    for (Eigen::Index i = 0; i < v.size(); ++i)
        if (dv[i] < 0) step = std::min(step, -v[i] / dv[i]);
    return step;
}

/// One point of the iteration, and what it lacks.
struct InteriorPoint {
    Eigen::VectorXd z, slack, multiplier, dual_residual, residual;
    double gap = 0;

    void measure(const QuadraticProgram& p) {
        dual_residual = p.H * z + p.g + p.A.transpose() * multiplier;
        residual = p.A * z + slack - p.b;
        gap = slack.dot(multiplier) / double(slack.size());
    }
    double lack() const { return std::max({dual_residual.cwiseAbs().maxCoeff(), residual.cwiseAbs().maxCoeff(), gap}); }
};

struct Direction {
    Eigen::VectorXd z, slack, multiplier;
};

/// Newton's direction towards slack times multiplier = -complement + what it is now.
Direction direction(const QuadraticProgram& p, const InteriorPoint& at, const Eigen::LLT<Eigen::MatrixXd>& factored,
                    const Eigen::VectorXd& complement) {
    Direction d;
    const Eigen::VectorXd pulled = (complement - at.multiplier.cwiseProduct(at.residual)).cwiseQuotient(at.slack);
    d.z = factored.solve(p.A.transpose() * pulled - at.dual_residual);
    d.slack = -at.residual - p.A * d.z;
    d.multiplier = (-complement - at.multiplier.cwiseProduct(d.slack)).cwiseQuotient(at.slack);
    return d;
}

}  // namespace

std::optional<ProgramSolution> solve(const QuadraticProgram& p) {
    const Eigen::Index n = p.g.size(), m = p.b.size();
    InteriorPoint at{.z = Eigen::VectorXd::Zero(n),
                     .slack = p.b.cwiseMax(0.1),
                     .multiplier = Eigen::VectorXd::Constant(m, 0.1),
                     .dual_residual = {},
                     .residual = {}};
    at.measure(p);
    for (int iteration = 0; iteration < kMostIterations && at.lack() > kExact; ++iteration) {
        Eigen::MatrixXd K = p.H;
        K.noalias() += p.A.transpose() * at.multiplier.cwiseQuotient(at.slack).asDiagonal() * p.A;
        const Eigen::LLT<Eigen::MatrixXd> factored(K);
        if (factored.info() != Eigen::Success) break;
        const Eigen::VectorXd product = at.slack.cwiseProduct(at.multiplier);
        const Direction predictor = direction(p, at, factored, product);
        const double far =
            std::min(longest_step(at.slack, predictor.slack), longest_step(at.multiplier, predictor.multiplier));
        const double reached =
            (at.slack + far * predictor.slack).dot(at.multiplier + far * predictor.multiplier) / double(m);
        const double centring = std::pow(reached / at.gap, 3);
        const Eigen::VectorXd complement = product + predictor.slack.cwiseProduct(predictor.multiplier) -
                                           Eigen::VectorXd::Constant(m, centring * at.gap);
        const Direction d = direction(p, at, factored, complement);
        const double step =
            kShortOfWall * std::min(longest_step(at.slack, d.slack), longest_step(at.multiplier, d.multiplier));
        if (!std::isfinite(step) || !d.z.allFinite()) break;
        at.z += step * d.z;
        at.slack += step * d.slack;
        at.multiplier += step * d.multiplier;
        at.measure(p);
    }
    if (!(at.lack() < kUsable) || !at.z.allFinite()) return std::nullopt;
    return ProgramSolution{at.z, at.multiplier};
}

}  // namespace tunewright::range
