// What a design over an operating range is asked: plants at places of a scheduling variable, or equations along which
// it moves, and how the user's controller can follow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/schedule/schedule.h"
#include "engine/plant/plant_family.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::range {

/// The quantity that the plant varies with. `at` of places and rows is in its unit, absolute.
struct Scheduling {
    std::string name = "at";
    std::string unit = {};
};

/// One plant of the range, perhaps with what is uncertain about it.
struct RangePoint {
    double at = 0;
    PlantFamily family;  ///< the first plant is nominal: IAE is its own; the limits hold on all
};

/// How the plants between two points are made.
enum class Between {
    parameters,          ///< logarithms of K, T, L, ... of one structure; linear where a sign or a 0 forbids them
    frequency_response,  ///< ln |P| and the unwrapped phase, linear in `at`: for unlike structures
};

/// What one setting for all points has the least of: IAE relative to each point's own optimum.
enum class Aim { worst, mean };

struct RangeOptions {
    ControllerKind controller = ControllerKind::PID;  ///< PI or PID
    PeakLimits limits = {};                           ///< held everywhere; no m_circle
    RobustFilterOptions filter = {};                  ///< empty: range_filter_rule
    Aim aim = Aim::worst;
    double b = 1;                  ///< set-point weight of every row, 0 to 1
    double allowance = 0.05;       ///< of each place's own IAE, > 0: what the schedule may cost
    std::optional<int> rows = {};  ///< of the schedule, 1 to 20; empty: the fewest
    Interpolation interpolation = Interpolation::linear_in_gains;
    double hysteresis = 0.02;  ///< of the range, 0 to 0.2: of `steps`
    Between between = Between::parameters;
};

/// The fewest and most points, and the most rows.
constexpr int kFewestPoints = 2, kMaxPoints = 20, kMaxRows = 20;

}  // namespace tunewright::range
