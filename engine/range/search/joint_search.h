// One search for the settings of many places at once: the least of the worst cost, limits held at every place.
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

/// The settings at a place `at` that the unknowns v mean, and how they move with them (`slope` may be null).
using SettingsMap = std::function<robust::DesignPoint(const Eigen::VectorXd& v, double at, SettingsSlope* slope)>;

struct JointProblem {
    std::vector<const PointDesign*> places;  ///< with their own optima
    SettingsMap settings;
    Aim aim = Aim::worst;
    /// Bounds of the unknowns, and the step of each that a first trust region allows.
    Eigen::VectorXd low, high, step;
};

struct JointOptions {
    int max_iterations = 30;
    double enough = -1;   ///< of ln of the cost: the search ends where it is met with the limits held
    double hopeless = 0;  ///< ends after two steps that won less than this part of what is left to `enough`; 0: never
    double cost_tolerance = 1e-5;  ///< ends where the model promises less
    double margin = 0;             ///< of ln of a limit's ratio: held this far inside
    double simulation_tolerance = 3e-4;
    std::stop_token stop = {};
};

struct JointResult {
    Eigen::VectorXd v;
    double log_cost_ratio = 0;  ///< of the aim; infinite where some loop is unstable
    double excess = 0;          ///< the largest ln of a limit's ratio plus the margin, on the searches' own grids
    bool stopped = false;

    /// The searches' own grids hold the limits as far as they can see.
    bool holds() const { return excess <= limits::kMaxRelativeExcessSearched; }
};

/// Sequential quadratic programming (numerics/optimise/sqp.h has its steps) with an exact penalty of the limits'
/// largest excess, so that a start need not hold them: minimise t + rho s subject to the linearised costs <= t and
/// limits <= s, s >= 0, in a trust region (Fletcher 1987, Practical Methods of Optimization, section 14.4). `start`
/// must be stable at every place.
JointResult search_jointly(const JointProblem& problem, const Eigen::VectorXd& start, const JointOptions& options,
                           const std::function<void(const JointResult&)>& report);

}  // namespace tunewright::range
