// Sequential quadratic programming in a trust region: minimises a smooth objective under smooth constraints. The
// problem gives values and gradients of both.
//
//  1. Step: the problem minimises its quadratic model, of matrix H, under its linearised constraints within the trust
//     region (Fletcher 1987, Practical Methods of Optimization, section 14.4: the region is a box).
//  2. If there is no step, the linearised constraints have no common point in the region, and it grows. With elastic
//     constraints they always have one: then rounding stopped the step, and the region shrinks.
//  3. The run has converged when the model predicts a decrease of less than `cost_tolerance`.
//  4. Candidate: the problem moves the step's end back to the curved constraints (a second-order correction, Nocedal
//     and Wright 2006, Numerical Optimization, section 18.3) and computes its merit function there.
//  5. The ratio of the actual to the predicted decrease of the merit function decides (Nocedal and Wright, algorithm
//     4.1): the candidate is accepted or the region shrinks; after a good one it grows.
//  6. H is updated by the curvature of the Lagrangian, from the change of its gradient: BFGS with Powell's damping
//     (Powell 1978, Numerical Analysis, Dundee 1977, 144-157), which stays positive definite even if the constraints'
//     curvature is not. Then 1.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>
#include <utility>

namespace tunewright::optimise {

/// Powell's damping has his published value; the others are usual values (Nocedal and Wright: 0 to 0.25 and 0.75 for
/// the ratios) and proved best both in the robust PID search and in the search over a range. They affect the number of
/// steps more than the results: on random plants `bench/robust_batch` measures the steps, `bench/robust_search` the
/// results.
struct SqpConstants {
    double min_ratio = 0.05;        ///< actual over predicted decrease: the least for a candidate to be accepted
    double good_ratio = 0.7;        ///< above it the region grows: the model is accurate over the whole step
    double shrink = 0.3;            ///< multiple of the failed step or of the radius, whichever is shorter
    double grow = 2;                ///< multiple of the radius
    double powell_damping = 0.2;    ///< of s'Hs: s'y is raised to at least this share
    double first_curvature = 0.3;   ///< of ln(cost) over logarithms, before gradients give an estimate
    double min_curvature = 1e-300;  ///< of s'Hs and s'y: a smaller one is no divisor
};
inline constexpr SqpConstants kSqp;

struct TrustRegion {
    double radius = 0.5;         ///< the initial one, in the problem's measure of a step's length
    double min_radius = 0;       ///< ends the run: no improvement is possible within it
    double max_radius = 1;       ///< after good steps
    double hopeless_radius = 4;  ///< ends the run: even within it the linearised constraints have no common point
};

struct SqpEnd {
    int iterations = 0;
    bool converged = false;  ///< false: the problem, the region or the number of steps ended the run
};

/// The operations that `minimise` needs of a problem. The problem's state holds values and gradients at one point.
template <class Problem>
concept SqpProblem = requires(Problem& problem, typename Problem::State& state, const typename Problem::State& before,
                              const typename Problem::Step& step, double number) {
    /// Linearised constraints always have a common point.
    { Problem::kElastic } -> std::convertible_to<bool>;
    /// The model's minimum in the region, and the decrease predicted there (`step.predicted`); empty: there is none.
    { problem.step(before, number) } -> std::same_as<std::optional<typename Problem::Step>>;
    { problem.length(step) } -> std::convertible_to<double>;
    /// False ends the run before the step is tried.
    { problem.worth_trying(before, step, number) } -> std::convertible_to<bool>;
    /// The step's end, corrected; empty: there is no candidate.
    { problem.candidate(before, step, number) } -> std::same_as<std::optional<typename Problem::State>>;
    { problem.merit(before) } -> std::convertible_to<double>;
    /// A candidate that decreased the merit by `number` is the new state; false ends the run.
    { problem.accepted(before, number) } -> std::convertible_to<bool>;
    /// Adds the objective's gradient.
    problem.differentiate(state);
    /// Updates H by the change between two states.
    problem.learn(before, before, step);
};

/// Moves `here`, which has a finite merit and its gradients, to a local minimum of the merit function.
template <SqpProblem Problem>
SqpEnd minimise(Problem& problem, typename Problem::State& here, const TrustRegion& region, int max_iterations,
                double cost_tolerance) {
    SqpEnd end;
    double radius = region.radius;
    for (; end.iterations < max_iterations; ++end.iterations) {
        const auto step = problem.step(here, radius);
        if (!step) {
            radius *= Problem::kElastic ? kSqp.shrink : kSqp.grow;
            if (radius < region.min_radius || radius > region.hopeless_radius) break;
            continue;
        }
        end.converged = step->predicted < cost_tolerance;
        if (end.converged || !problem.worth_trying(here, *step, radius)) break;
        auto next = problem.candidate(here, *step, radius);
        const double won = next ? problem.merit(here) - problem.merit(*next) : -std::numeric_limits<double>::infinity();
        if (!(won > kSqp.min_ratio * step->predicted)) {
            radius = kSqp.shrink * std::min(radius, problem.length(*step));
            if (radius < region.min_radius) break;
            continue;
        }
        if (won > kSqp.good_ratio * step->predicted) radius = std::min(kSqp.grow * radius, region.max_radius);
        const auto before = std::exchange(here, *std::move(next));
        if (!problem.accepted(here, won)) break;
        problem.differentiate(here);
        problem.learn(before, here, *step);
    }
    return end;
}

/// BFGS with Powell's damping: updates H, n x n, by the change y of the Lagrangian's gradient over the step s. H stays
/// positive definite.
template <class Matrix, class Vector>
void update_curvature(Matrix& H, const Vector& s, Vector y) {
    const Vector Hs = H * s;
    const double sHs = s.dot(Hs), sy = s.dot(y);
    if (!(sHs > kSqp.min_curvature)) return;
    if (sy < kSqp.powell_damping * sHs) {
        const double theta = (1 - kSqp.powell_damping) * sHs / (sHs - sy);
        y = theta * y + (1 - theta) * Hs;
    }
    const double scale = s.dot(y);
    if (scale > kSqp.min_curvature) H += y * y.transpose() / scale - Hs * Hs.transpose() / sHs;
}

}  // namespace tunewright::optimise
