// The problem of a design over an operating range: plants at values of a scheduling variable, or equations, and the way
// in which the user's controller can follow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/plant/plant_family.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::range {

/// The quantity with which the plant varies. `at` of points and rows is in its unit, absolute.
struct Scheduling {
    std::string name = "at";
    std::string unit = {};
};

/// One plant of the range, perhaps with uncertainty.
struct RangePoint {
    double at = 0;
    PlantFamily family;  ///< the first plant is nominal: IAE is its own; the limits hold on all
};

/// The interpolation of plants between two points.
enum class Between {
    parameters,          ///< logarithms of K, T, L, ... of one structure are linear; the numbers themselves if a sign
                         ///< or a 0 requires it
    frequency_response,  ///< ln |P| and the unwrapped phase are linear in `at`: for different structures
};

/// The objective of one setting for all points: the worst or the mean IAE relative to each point's own optimum.
enum class Aim { worst, mean };

struct RangeOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    PeakLimits limits = {};                           ///< kept everywhere; m_circle is not allowed
    RobustFilterOptions filter = {};                  ///< empty: range_filter_rule
    Aim aim = Aim::worst;
    double b = 1;                  ///< set-point weight of every row, 0 to 1
    double allowance = 0.05;       ///< largest relative cost of the schedule above each point's own IAE, > 0
    std::optional<int> rows = {};  ///< rows of the schedule, 1 to 20; empty: as few as possible
    Interpolation interpolation = Interpolation::linear_in_gains;
    double hysteresis = 0.02;  ///< for `steps`, as a share of the range, 0 to 0.2
    Between between = Between::parameters;
};

/// The smallest and largest number of points, and the largest number of rows.
constexpr int kFewestPoints = 2, kMaxPoints = 20, kMaxRows = 20;

}  // namespace tunewright::range
