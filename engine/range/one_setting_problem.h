// The search for one setting of many places as a problem of search_jointly.
//
//   const JointProblem joint = one_setting_problem(places, options);
//   const JointResult end = search_jointly(joint, unknowns_of(joint, start), {}, {});
//   const robust::DesignPoint x = joint.settings(end.v, 0, nullptr);   // the same at every place
//
// Apart from one_setting.h, whose readers need no matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/range/problem.h"
#include "engine/range/search/joint_search.h"
#include "engine/range/search/point_design.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::range {

/// Of these places (at least one, with their optima): unknowns ln Kp, ln Ti, and ln Td of PID. `PI`: Td is 0 although a
/// PID was asked for. A filter tied to Td shrinks with it, so that no small Td comes near a PI on a plant whose gain
/// does not fall with frequency. Bounds: of Ti by the fastest place, of Td by the fastest and the slowest (kMinTi,
/// kMinTd and kMaxTd of robust designs); Kp is free. The places live as long as the problem.
JointProblem one_setting_problem(const std::vector<PointDesign*>& points, const RangeOptions& options, bool PI = false);

/// x as the unknowns of such a problem. Where it searches for a PID, Td is raised to the least that it allows: a design
/// without derivative action has ln Td = -infinity, from where no search moves.
Eigen::VectorXd unknowns_of(const JointProblem& joint, const robust::DesignPoint& x);

}  // namespace tunewright::range
