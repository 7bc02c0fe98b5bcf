// The settings of a schedule's rows as the unknowns of a search.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/range/schedule/own_optima.h"
#include "engine/range/search/joint_search.h"

namespace tunewright::range {

/// Unknowns: ln Kp, ln Ti (and ln Td) of each row in turn, for the kinds that are linear between rows. The rows' places
/// are fixed: if they moved past the search's own points, the cost would have kinks.
class Knots {
public:
    Knots(const PointDesigns& places, Interpolation interpolation, std::vector<double> at);

    /// Makes the row at this value, if there is one, a PI: its Td is 0, whatever the unknown.
    void leave_out_derivative(double at);

    /// The own optima at the rows' values.
    Eigen::VectorXd start(const OwnOptima& own) const;
    /// The same setting for all rows.
    Eigen::VectorXd constant(const robust::DesignPoint& x) const;
    robust::DesignPoint settings(const Eigen::VectorXd& v, double at, SettingsSlope* slope) const;
    /// Bounds, steps and settings. The points are left empty.
    JointProblem problem() const;
    Schedule schedule(const Eigen::VectorXd& v, const DesignRules& rules, double b) const;

private:
    Eigen::Index rows() const { return Eigen::Index(at_.size()); }
    Eigen::Index unknowns() const { return dimension_ * rows(); }
    bool absent(Eigen::Index row, Eigen::Index i) const { return i == 2 && PI_[std::size_t(row)]; }

    Interpolation interpolation_;
    std::vector<double> at_;
    std::vector<bool> PI_;  ///< true for each row that is a PI
    double fastest_ = 0, slowest_ = 0;
    Eigen::Index dimension_;
};

}  // namespace tunewright::range
