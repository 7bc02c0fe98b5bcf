// Sequential quadratic programming in a trust region: a smooth objective under smooth constraints, of both of which the
// problem gives values and gradients.
//
//  1. Step: the problem minimises its quadratic model, of matrix H, under its linearised constraints within the trust
//     region (Fletcher 1987, Practical Methods of Optimization, section 14.4: the region is a box).
//  2. Where there is no step the region grows, as the linearised constraints have no common point in it; with
//     constraints that are elastic they always have one, and it shrinks: rounding stopped the step.
//  3. The run has converged where the model promises less than `cost_tolerance`.
//  4. Candidate: the problem moves the step's end back to the curved constraints (a second-order correction, Nocedal
//     and Wright 2006, Numerical Optimization, section 18.3) and computes its merit function there.
//  5. The ratio of what the merit function fell by to what the model promised decides (Nocedal and Wright, algorithm
//     4.1): the candidate is taken or the region shrinks; after a good one it grows.
//  6. H learns the curvature of the Lagrangian from the change of its gradient: BFGS with Powell's damping (Powell
//  1978,
//     Numerical Analysis, Dundee 1977, 144-157), positive definite where the constraints' curvature is not. Then 1.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>
#include <utility>

namespace tunewright::optimise {

/// Powell's damping is his own; the others are usual values (Nocedal and Wright: 0 to 0.25 and 0.75 for the ratios) at
/// which the robust PID search and the search over a range both arrived. They affect the number of steps more than the
/// answers: `bench/robust_batch` measures the one, `bench/robust_search` the other, on random plants.
struct SqpConstants {
    double min_ratio = 0.05;        ///< of what was won to what was promised, for a candidate to be taken
    double good_ratio = 0.7;        ///< from it on the region grows: the model is right as far as it was followed
    double shrink = 0.3;            ///< times the step that failed or the radius, whichever is shorter
    double grow = 2;                ///< times the radius
    double powell_damping = 0.2;    ///< of s'Hs, which s'y keeps at least
    double first_curvature = 0.3;   ///< of ln(cost) over logarithms, before gradients have shown it
    double min_curvature = 1e-300;  ///< of s'Hs and s'y: a smaller one cannot be divided by
};
inline constexpr SqpConstants kSqp;

struct TrustRegion {
    double radius = 0.5;         ///< the first one, in the problem's measure of a step's length
    double min_radius = 0;       ///< ends the run: nothing is left to win in it
    double max_radius = 1;       ///< after good steps
    double hopeless_radius = 4;  ///< ends the run: even in it the linearised constraints have no common point
};

struct SqpEnd {
    int iterations = 0;
    bool converged = false;  ///< the model promises too little; else the problem, the region or the count ended it
};

/// What a problem is to `minimise`. Its state holds values and gradients at one point.
template <class Problem>
concept SqpProblem = requires(Problem& problem, typename Problem::State& state, const typename Problem::State& before,
                              const typename Problem::Step& step, double number) {
    /// Linearised constraints always have a common point.
    { Problem::kElastic } -> std::convertible_to<bool>;
    /// The model's minimum in the region, and what it promises (`step.promised`); empty: there is none.
    { problem.step(before, number) } -> std::same_as<std::optional<typename Problem::Step>>;
    { problem.length(step) } -> std::convertible_to<double>;
    /// False ends the run before the step is tried.
    { problem.worth_trying(before, step, number) } -> std::convertible_to<bool>;
    /// The step's end, corrected; empty: it is no candidate.
    { problem.candidate(before, step, number) } -> std::same_as<std::optional<typename Problem::State>>;
    { problem.merit(before) } -> std::convertible_to<double>;
    /// A candidate that won `number` is the state now; false ends the run.
    { problem.accepted(before, number) } -> std::convertible_to<bool>;
    /// Adds the objective's gradient.
    problem.differentiate(state);
    /// H from the change between two states.
    problem.learn(before, before, step);
};

/// Moves `here`, whose merit is finite and which has its gradients, to a local minimum of the merit function.
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
        end.converged = step->promised < cost_tolerance;
        if (end.converged || !problem.worth_trying(here, *step, radius)) break;
        auto next = problem.candidate(here, *step, radius);
        const double won = next ? problem.merit(here) - problem.merit(*next) : -std::numeric_limits<double>::infinity();
        if (!(won > kSqp.min_ratio * step->promised)) {
            radius = kSqp.shrink * std::min(radius, problem.length(*step));
            if (radius < region.min_radius) break;
            continue;
        }
        if (won > kSqp.good_ratio * step->promised) radius = std::min(kSqp.grow * radius, region.max_radius);
        const auto before = std::exchange(here, *std::move(next));
        if (!problem.accepted(here, won)) break;
        problem.differentiate(here);
        problem.learn(before, here, *step);
    }
    return end;
}

/// BFGS with Powell's damping: H, n x n, learns from the Lagrangian's gradient having changed by y over the step s.
/// Stays positive definite.
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
