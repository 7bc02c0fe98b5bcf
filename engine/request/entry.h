// One entry of an answer: a controller with everything known about it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/request/device_entry.h"
#include "engine/request/optimum_at_ms.h"
#include "engine/request/own_step/own_step_entry.h"
#include "engine/request/replay/replay_entry.h"
#include "engine/request/verdict/finding.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// The groups of a comparison, the best first.
enum class StandingGroup {
    holds,
    above_limit,  ///< settles, with a larger Ms than its own limit or the common one
    not_settled,  ///< stable, but a response does not settle at its target
    unstable,
};

/// The standing of an entry in a comparison, and the reason why it stands behind others.
struct Standing {
    StandingGroup group = StandingGroup::unstable;
    bool settles = false;   ///< stable, and both responses settle at their targets
    bool within = true;     ///< Ms is within the limit that was set for this entry; true without a limit
    Figure Ms;              ///< of the implemented loop on the worst plant
    Figure min_limit;       ///< the least common limit on Ms that this entry keeps; none where no limit helps
    Figure excess_percent;  ///< load IAE above the least at the same Ms; the ranking's criterion
    int order = 0;          ///< position, from 1, without a common limit on Ms
    std::string why;        ///< the reason why it is not in the first group; empty if it is
    bool holds() const { return group == StandingGroup::holds; }
};

/// The loop to which a known peak belongs: the ideal one, that of the user's controller, or the one of them that runs
/// on the worst of several plants.
enum class PeakLoop { ideal, on_device, worst_plant };

struct PlacedPeak {
    double value = 0;
    PeakLoop loop = PeakLoop::ideal;
    bool on_worst_plant() const { return loop == PeakLoop::worst_plant; }
    /// True if the value exceeds its limit by more than the tolerance for showing that the limit is kept
    /// (tuning/limits.h). Ranking and verdict use this.
    bool exceeds(double limit) const;
};

/// The words in place of a method's id for settings that the request gives.
inline constexpr const char *kGivenMethod = "given", *kBaselineMethod = "baseline";

/// A controller with its evaluation, or the error in its place.
struct TuningEntry {
    /// Id; one of the two above for settings of the request; empty for controllers that were sent to be evaluated.
    std::string method;
    std::string title;
    std::string source;
    bool over_region = false;  ///< limits hold over the record's confidence region, not for its model alone
    /// Load IAE of an entry over the region, divided by that of the same method on the model alone.
    std::optional<double> region_cost;
    MethodOptions options;  ///< the given ones, with the defaults for the others
    std::optional<Plant> reduced_model;
    std::optional<double> Ms_limit;            ///< the limit that the method designed for
    std::optional<double> asked_Ms;            ///< the same limit if the request set it or the method is to keep it
    std::optional<double> asked_overshoot;     ///< percent of the step, where the request has one
    Reports reports;                           ///< the method's own, and those requested for every controller
    std::optional<OptimumAtMs> optimum_at_Ms;  ///< if requested
    std::optional<double> best_PI_load_IAE;  ///< of a robust PID: the load IAE of the robust PI within the same limits
    std::optional<DeviceEntry> on_device;    ///< if requested and possible
    std::optional<ReplayedEntry> replay;     ///< the recorded time with this controller
    std::optional<OwnStepEntry> own_step;    ///< if requested
    std::optional<Standing> standing;        ///< not for settings without a plant
    /// Not for today's settings: the longest sample time of a program with backward rules that keeps Ms within 5 %.
    std::optional<Figure> longest_sample_time;
    std::optional<Controller> unjudged;    ///< the controller, if there is no plant to evaluate it on
    std::optional<Evaluation> evaluation;  ///< its list of warnings begins with those of the method
    std::optional<Error> error;
    std::vector<verdict::Finding> verdict;  ///< the most important finding first

    bool is_baseline() const { return method == kBaselineMethod; }  ///< today's settings
    /// No method made it, so that it has neither options nor limits of its own.
    bool is_given() const { return method.empty() || method == kGivenMethod || is_baseline(); }

    /// The report of this type; null if there is none.
    template <class Report>
    const Report* report_as() const {
        return report_among<Report>(reports);
    }
};

/// Figures over several plants of the loop that runs: that of the user's controller where it is known. The entry has an
/// evaluation.
const std::optional<RegionFigures>& region_of(const TuningEntry& entry);

/// Ms of the loop that runs (of the ideal one where it has none), or that on the worst of several plants where it is
/// larger. The entry has an evaluation.
std::optional<PlacedPeak> worst_Ms(const TuningEntry& entry);
/// The same of Mt, which is not known on the worst plant.
std::optional<PlacedPeak> worst_Mt(const TuningEntry& entry);

/// Sets one horizon for the responses of all entries: ideal and implemented, of the equations and of their
/// linearisation.
void draw_together(std::vector<TuningEntry>& entries);

}  // namespace tunewright
