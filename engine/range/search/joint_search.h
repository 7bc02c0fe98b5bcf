// One search for the settings of many points at once: the least worst cost, with the limits kept at every point.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <stop_token>
#include <vector>

#include "engine/range/problem.h"
#include "engine/range/search/point_design.h"
#include "engine/tuning/limits.h"

namespace tunewright::range {

/// 3 x n: the derivatives of ln Kp, ln Ti, ln Td by the unknowns.
using SettingsSlope = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// The settings at `at` for the unknowns v, and their derivatives (`slope` may be null).
using SettingsMap = std::function<robust::DesignPoint(const Eigen::VectorXd& v, double at, SettingsSlope* slope)>;

struct JointProblem {
    std::vector<const PointDesign*> places;  ///< with their own optima
    SettingsMap settings;
    Aim aim = Aim::worst;
    /// Bounds of the unknowns, and the step of each in the first trust region.
    Eigen::VectorXd low, high, step;
};

struct JointOptions {
    int max_iterations = 30;
    double enough = -1;   ///< ln of the cost: the search ends when it is reached with the limits kept
    double hopeless = 0;  ///< ends after two steps with less than this share of the remaining decrease to `enough`; 0:
                          ///< never
    double cost_tolerance = 1e-5;  ///< ends when the model predicts a smaller decrease
    double margin = 0;             ///< of ln of a limit's ratio: limits are tightened by it
    double simulation_tolerance = 3e-4;
    std::stop_token stop = {};
};

struct JointResult {
    Eigen::VectorXd v;
    double log_cost_ratio = 0;  ///< of the objective; infinite if some loop is unstable
    double excess = 0;          ///< the largest ln of a limit's ratio plus the margin, on the grids of the searches
    bool stopped = false;

    /// True if the limits hold on the grids of the searches.
    bool holds() const { return excess <= limits::kMaxRelativeExcessSearched; }
};

/// Sequential quadratic programming (numerics/optimise/sqp.h has its steps) with an exact penalty on the largest
/// excess, so that a start need not keep the limits: minimise t + rho s subject to the linearised costs <= t and limits
/// <= s, s >= 0, in a trust region (Fletcher 1987, Practical Methods of Optimization, section 14.4). `start` must be
/// stable at every point.
JointResult search_jointly(const JointProblem& problem, const Eigen::VectorXd& start, const JointOptions& options,
                           const std::function<void(const JointResult&)>& report);

}  // namespace tunewright::range
