// The least cost of a few settings under limits on peaks over frequency: settings of loops that are closed together.
//
// 1. Sequential quadratic programming (numerics/optimise/sqp.h) over the logarithms of the settings. The cost's
// gradient
//    is a difference; that of a peak is the derivative of the function at the peak's frequency, because the peak is a
//    maximum over frequency (Danskin 1967).
// 2. The peaks of the result are computed on a grid that resolves every turn of the dead times. If one exceeds its
//    limit, because the search's grid missed it, 1 continues with a limit that is lower by this excess.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <stop_token>
#include <vector>

namespace tunewright::structure {

/// A local maximum over frequency of a function with a limit.
struct LimitedPeak {
    int function = 0;
    double omega = 0;
    double excess = 0;  ///< ln of the value over the limit
};

struct LimitedProblem {
    int functions = 1;  ///< with limits
    /// All loops that must be stable are. Not asked for small differences about a stable x: with bounded peaks these
    /// change the loop's gain by too little (small gain theorem).
    std::function<bool(const Eigen::VectorXd& x)> stable;
    /// ln of the cost at a stable x.
    std::function<double(const Eigen::VectorXd& x)> log_cost;
    /// Local maxima of all functions at x, those near their limits at least; the cost is not asked for where one of
    /// them exceeds its limit by far.
    std::function<std::vector<LimitedPeak>(const Eigen::VectorXd& x)> peaks;
    /// ln of one function over its limit at one frequency.
    std::function<double(const Eigen::VectorXd& x, int function, double omega)> excess_at;
    /// ln of the highest peak of each function over its limit, every peak resolved.
    std::function<std::vector<double>(const Eigen::VectorXd& x)> resolved_excess;
    Eigen::VectorXd low, high;  ///< bounds of x
};

struct LimitedResult {
    Eigen::VectorXd x;
    double log_cost = std::numeric_limits<double>::infinity();
    double excess = std::numeric_limits<double>::infinity();  ///< the largest resolved one; <= 0: all limits hold
    Eigen::MatrixXd curvature;                                ///< of the Lagrangian, as the search has learnt it
    bool stopped = false;
};

struct LimitedOptions {
    int max_iterations = 40;
    int max_rounds = 5;  ///< of searches with lower and lower limits: the second mostly suffices
    double cost_tolerance = 1e-5;
    double difference = 2e-3;        ///< of x, for the gradient of the cost
    Eigen::MatrixXd curvature = {};  ///< where a search continues: that of its last result
    std::stop_token stop = {};
};

/// What the search lowers: the cost, and the excess at a price.
double merit_of(double log_cost, double excess);

/// `start` must be stable; it need not keep the limits. The result keeps them to 1e-6 of ln unless its `excess` says
/// otherwise.
LimitedResult search_within_limits(const LimitedProblem& problem, const Eigen::VectorXd& start,
                                   const LimitedOptions& options);

}  // namespace tunewright::structure
