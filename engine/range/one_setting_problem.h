// The search for one setting at many points, as a problem of search_jointly.
//
//   const JointProblem joint = one_setting_problem(places, options);
//   const JointResult end = search_jointly(joint, unknowns_of(joint, start), {}, {});
//   const robust::DesignPoint x = joint.settings(end.v, 0, nullptr);   // the same at every place
//
// Separate from one_setting.h, whose users need no matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/range/problem.h"
#include "engine/range/search/joint_search.h"
#include "engine/range/search/point_design.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::range {

/// The problem for these points (at least one, with their optima). Unknowns: ln Kp, ln Ti, and for a PID ln Td. `PI`:
/// Td is 0 although a PID was requested: a filter tied to Td shrinks with it, so on a plant whose gain does not fall
/// with frequency no small Td is equivalent to a PI. Bounds: for Ti by the fastest point, for Td by the fastest and the
/// slowest (kMinTi, kMinTd and kMaxTd of robust designs); Kp has no bounds. The points must outlive the problem.
JointProblem one_setting_problem(const std::vector<PointDesign*>& points, const RangeOptions& options, bool PI = false);

/// x as the unknowns of such a problem. For a PID, Td is raised to the least allowed value: a design without derivative
/// action has ln Td = -infinity, from which no search can start.
Eigen::VectorXd unknowns_of(const JointProblem& joint, const robust::DesignPoint& x);

}  // namespace tunewright::range
