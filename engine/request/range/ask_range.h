// Designs and evaluates a loop over its whole operating range. Input: points with their plants or records, or
// equations. Output: one setting, a schedule, their curves and their runs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/figure.h"
#include "engine/identification/identify.h"
#include "engine/plant/plant_family.h"
#include "engine/range/design_range.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/range/run/profile.h"
#include "engine/range/run/scheduled_run.h"
#include "engine/request/verdict/finding.h"

namespace tunewright {

/// The request of a range: exactly one of `points` and `branch`.
struct RangeQuestion {
    struct Point {
        double at = 0;
        std::variant<PlantFamily, Record> content;
    };
    range::Scheduling scheduling;
    std::vector<Point> points;
    std::shared_ptr<const range::SteadyBranch> branch;
    IdentifyOptions identify;  ///< for every record
    bool over_region = false;  ///< limits hold over each record's 95 % confidence region
    range::RangeOptions options;
    std::vector<ScheduleRow> given;  ///< a schedule to evaluate in place of a design, ascending; empty: none
    bool runs = true;                ///< for equations: simulate passages across the range
};

/// The plant at a point of the range, with the model or steady state that it comes from.
struct RangePointPlant {
    double at = 0;
    Plant plant;
    std::optional<IdentifiedModel> model;  ///< the identified model, if the point has a record
    std::optional<double> u, y;            ///< for equations: the steady state, absolute
};

/// Plant parameters that vary over the range.
/// K: static gain, or the slope of an integrating plant; T: sum of the lags less the leads; L: dead time. Empty if only
/// the frequency response is known.
struct RangePlace {
    double at = 0;
    std::optional<double> K, T, L, u, y;
};

/// One passage across the range, simulated with each of the two controllers that exist.
struct RangePassage {
    range::Passage passage;
    std::optional<range::ScheduledRun> one, schedule;
    OrReason<range::LinearisingPassage> nonlinear;  ///< with a controller that knows the equations and their states
};

struct RangeResult {
    range::Scheduling scheduling;
    double low = 0, high = 0;
    std::vector<RangePointPlant> points;
    range::RangeDesign design;
    bool given = false;              ///< true: the schedule was given, so there is no one setting, and the verdict is
                                     ///< on the schedule
    std::vector<RangePlace> places;  ///< at the points of the curves
    std::vector<RangePassage> runs;
    std::optional<verdict::Finding> verdict;
    double compute_ms = 0;
};

/// Errors: those of identification, with the point in `where` ("points/2/record"); of model_of_points and
/// model_of_branch; of design_range and judge_schedule, whose "options/..." become "schedule/..."; cancelled if it was
/// stopped before anything was found. Progress: "identify", "tune", "schedule", "evaluate".
Expected<RangeResult> ask_range(const RangeQuestion& question, const RunControl& control);

/// Moves an error's place from a plant of the range to its place in the request.
Error in_range_request(Error error, const RangeQuestion& question);

}  // namespace tunewright
