// The own optimum of every point over the range, as a table that is interpolated between its rows: the settings that a
// schedule approximates, and the reference of its cost.
#pragma once

#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/range/problem.h"
#include "engine/range/search/point_designs.h"

namespace tunewright::range {

class OwnOptima {
public:
    static constexpr std::size_t kMaxRangePoints = 48;

    /// Searches the optima at the points of the model, and between them until neighbours differ by at most about 30 %
    /// in Kp, Ti and IAE, at most `max` points (3 or more; all points of the model are used in any case). Errors: those
    /// of PointDesigns::at.
    static Expected<OwnOptima> over(PointDesigns& places, std::size_t max = kMaxRangePoints);

    /// Updates the table from all points that are known now.
    void renew(const PointDesigns& places);

    const std::vector<double>& at() const { return at_; }
    const std::vector<robust::DesignPoint>& x() const { return rows_; }

    /// ln of a point's own least IAE: cubic between the rows, with the slopes of parabolas through three rows.
    double log_IAE(double at) const;

    /// The optimum at a value, in logarithms: cubic between the rows in the same way.
    robust::DesignPoint optimum(double at) const;

    /// The best places for `rows` rows, ends included: they minimise the largest error of the interpolated settings
    /// against the optima, in ln Kp and ln(Kp/Ti). Every part is as long as the common error allows. `error`: half the
    /// spread over a part.
    struct Layout {
        std::vector<double> at;
        double error = 0;
    };
    Layout layout(int rows, Interpolation interpolation) const;

private:
    /// Value and optimum on an even grid over the range.
    struct Grid {
        std::vector<double> at;
        std::vector<robust::DesignPoint> x;
    };
    Grid fine_grid() const;
    double interpolated(const std::vector<double>& value, double at) const;

    std::vector<double> at_, log_IAE_;
    std::vector<double> x_[3];
    std::vector<robust::DesignPoint> rows_;
};

}  // namespace tunewright::range
