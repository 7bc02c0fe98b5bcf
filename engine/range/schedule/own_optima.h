// Every place's own optimum over the range, as a table between whose rows it is interpolated: what a schedule would
// follow, and what its cost is measured against.
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

    /// Looks at the points of the model, and between them until neighbours differ by no more than 30 % or so in Kp,
    /// Ti and IAE, at most `max` places (3 or more; points beyond it are looked at all the same). Errors: those of
    /// PointDesigns::at.
    static Expected<OwnOptima> over(PointDesigns& places, std::size_t max = kMaxRangePoints);

    /// The table from all places that are known by now.
    void renew(const PointDesigns& places);

    const std::vector<double>& at() const { return at_; }
    const std::vector<robust::DesignPoint>& x() const { return rows_; }

    /// ln of a place's own least IAE: cubic between the rows, with slopes of the parabola through three.
    double log_IAE(double at) const;

    /// The optimum of a place, in logarithms: cubic between the rows in the same way.
    robust::DesignPoint optimum(double at) const;

    /// The best places for `rows` rows, ends included, judged by how far the settings that the controller interpolates
    /// lie from the optima in ln Kp and ln(Kp/Ti): every part as long as one common error lets it be, and the least
    /// such error. `error`: half the spread over a part.
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
