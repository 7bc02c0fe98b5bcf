// A schedule's rows and the places of its inner ones as the unknowns of a search.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/range/schedule/own_optima.h"
#include "engine/range/schedule/schedule.h"
#include "engine/range/search/joint_search.h"

namespace tunewright::range {

/// Unknowns: ln Kp, ln Ti (and ln Td) of each row in turn, then the places of the inner rows in parts of the range. The
/// kinds that are linear between rows.
class Knots {
public:
    Knots(const Places& places, Interpolation interpolation, std::vector<double> at);

    /// The own optima of the rows' places.
    Eigen::VectorXd start(const OwnOptima& own) const;
    robust::DesignPoint settings(const Eigen::VectorXd& v, double at, SettingsSlope* slope) const;
    /// Bounds and steps; settings. The places are left empty. An inner row moves no further than halfway to its
    /// neighbours.
    JointProblem problem() const;
    Schedule schedule(const Eigen::VectorXd& v, const DesignRules& rules, double b) const;

private:
    Eigen::Index rows() const { return Eigen::Index(at_.size()); }
    Eigen::Index unknowns() const { return dimension_ * rows() + std::max<Eigen::Index>(0, rows() - 2); }
    double place(const Eigen::VectorXd& v, Eigen::Index row) const;

    Interpolation interpolation_;
    std::vector<double> at_;
    double low_, span_, fastest_ = 0, slowest_ = 0;
    Eigen::Index dimension_;
};

}  // namespace tunewright::range
