// The model of the plant over a range.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/frequency_response.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/range/problem.h"
#include "engine/warning.h"

namespace tunewright::range {

class SteadyBranch;

/// The plant at one point: a linear one with the members of its family, or points of its frequency response.
struct PointModel {
    double at = 0;
    std::optional<LinearPlant> nominal;  ///< empty: `measured` is used in its place
    std::vector<LinearPlant> members;    ///< further plants on which the limits hold
    std::optional<MeasuredPlant> measured;
    std::optional<PlantFamily> family = {};  ///< at a given point with uncertainty: the region over which the limits
                                             ///< hold
    std::optional<double> u = {}, y = {};    ///< from equations: the steady state, absolute
};

class RangeModel {
public:
    virtual ~RangeModel() = default;

    double low() const { return low_; }
    double high() const { return high_; }
    /// Ascending, both ends included: the given points; for equations, points chosen over the range.
    const std::vector<double>& points() const { return points_; }
    /// The model of the plant between the points, as a sentence.
    const std::string& stated() const { return stated_; }
    const std::vector<Warning>& warnings() const { return warnings_; }
    /// False if plants between the points are known only by their frequency response.
    bool has_responses() const { return has_responses_; }

    /// `place` in [low, high].
    virtual Expected<PointModel> at(double place) const = 0;

protected:
    double low_ = 0, high_ = 0;
    std::vector<double> points_;
    std::string stated_;
    bool has_responses_ = true;
    std::vector<Warning> warnings_;
};

/// All errors of the points' places, `where` = "points" or "points/k/at": fewer than 2 or more than 20, not finite, not
/// strictly ascending.
std::vector<Error> place_faults(const std::vector<double>& places);

/// Models between given points. Points ascend strictly in `at`.
///
/// `parameters`: ln of K, T, T1, T2, zeta, L and of a transfer function's coefficients is linear in `at` between
/// neighbours, or the parameter itself if its values differ in sign or one is 0. Sopdt's time constants are in
/// descending order. Uncertainty: each member of a neighbour's family, as ratios to its nominal parameters, is paired
/// with the most similar member of the other neighbour's family; the logarithms of the ratios are linear in `at` too.
/// If a parameter is uncertain in one of the families only, each outermost member is also paired with every outermost
/// one of the other that deviates to the opposite side in no parameter: all corners of ranges are enclosed.
///
/// `frequency_response`: ln |P| and the unwrapped phase are linear in `at` between neighbours, at 160 frequencies; such
/// a point has no response over time, so Ti/Kp replaces the IAE over the range, both for the schedule and for the own
/// optimum. The numbers of integrators and unstable poles must be equal.
///
/// Errors: invalid_argument, `where` = "points", "points/k/at": fewer than 2 or more than 20 points, places not
/// ascending or not finite; "points/k/plant": as LinearPlant::make; different structures with `parameters`; different
/// numbers of integrators or unstable poles with `frequency_response`; no_feasible_controller: the sign of the gain
/// changes between two points.
Expected<std::shared_ptr<const RangeModel>> model_of_points(const std::vector<RangePoint>& points, Between between);

/// The model of equations on their branch of steady states (equations/steady_branch.h). Nothing is interpolated: every
/// point has its own steady state and linearisation. Points: five, evenly over the range. Warnings: "input-folds" if
/// the input has turning points along the branch. Errors of `at`: those of SteadyBranch::at and LinearPlant::make, with
/// the place in the message.
Expected<std::shared_ptr<const RangeModel>> model_of_branch(std::shared_ptr<const SteadyBranch> branch);

}  // namespace tunewright::range
