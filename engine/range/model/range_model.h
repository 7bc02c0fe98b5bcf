// The plant everywhere in a range.
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

/// The plant at one place: a linear one with the members of its family, or points of its frequency response.
struct PointModel {
    double at = 0;
    std::optional<LinearPlant> nominal;  ///< empty: `measured` stands in its place
    std::vector<LinearPlant> members;    ///< further plants on which the limits hold
    std::optional<MeasuredPlant> measured;
    std::optional<PlantFamily> family = {};  ///< at a given point with uncertainty: what the limits hold on inside
    std::optional<double> u = {}, y = {};    ///< from equations: the steady state, absolute
};

class RangeModel {
public:
    virtual ~RangeModel() = default;

    double low() const { return low_; }
    double high() const { return high_; }
    /// Ascending, both ends included: the points that were given; of equations, places chosen over the range.
    const std::vector<double>& points() const { return points_; }
    /// How the plant between the points is known, as a sentence.
    const std::string& stated() const { return stated_; }
    const std::vector<Warning>& warnings() const { return warnings_; }
    /// False where plants between the points are known by their frequency response alone.
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

/// Every fault of the points' places, `where` = "points" or "points/k/at": fewer than 2 or more than 20, not finite,
/// not ascending strictly.
std::vector<Error> place_faults(const std::vector<double>& places);

/// Models between given points. Points ascend strictly in `at`.
///
/// `parameters`: ln of K, T, T1, T2, zeta, L and of a transfer function's coefficients is linear in `at` between
/// neighbours, the parameter itself where its values differ in sign or one is 0. Sopdt's time constants go in
/// descending order. Uncertainty: each member of a neighbour's family, as ratios to its nominal parameters, is taken
/// together with the member of the other neighbour's that lies off most alike; the logarithms of the ratios are linear
/// in `at` too. Where a parameter is uncertain in one of the families alone, so is each outermost member with every
/// outermost one of the other that lies in no parameter to the opposite side: all corners of ranges are enclosed.
///
/// `frequency_response`: ln |P| and the unwrapped phase are linear in `at` between neighbours, at 160 frequencies; such
/// a place has no response over time, so over the range Ti/Kp stands for the IAE, for schedule and own optimum alike.
/// Integrators and unstable poles must be alike.
///
/// Errors: invalid_argument, `where` = "points", "points/k/at": fewer than 2 or more than 20 points, places not
/// ascending or not finite; "points/k/plant": as LinearPlant::make; unlike structures with `parameters`; other counts
/// of integrators or unstable poles with `frequency_response`; no_feasible_controller: the sign of the gain changes
/// between two points.
Expected<std::shared_ptr<const RangeModel>> model_of_points(const std::vector<RangePoint>& points, Between between);

/// The model of equations on their branch of steady states (equations/steady_branch.h). Nothing is interpolated: every
/// place has its own steady state and linearisation. Points: five places evenly over the range. Warnings: "input-folds"
/// where the input turns back along the branch. Errors of `at`: those of SteadyBranch::at and LinearPlant::make, with
/// the place in the sentence.
Expected<std::shared_ptr<const RangeModel>> model_of_branch(std::shared_ptr<const SteadyBranch> branch);

}  // namespace tunewright::range
