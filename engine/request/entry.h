// One line of an answer: a controller with everything known about it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/request/device_entry.h"
#include "engine/request/optimum_at_ms.h"
#include "engine/request/replay/replay_entry.h"
#include "engine/request/verdict/finding.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// The groups of a comparison, the best first.
enum class StandingGroup {
    holds,
    above_limit,  ///< settles, with a larger Ms than was asked of it or of all
    not_settled,  ///< stable, but a response does not come to rest where it should
    unstable,
};

/// How an entry stands in a comparison, and why it stands behind others.
struct Standing {
    StandingGroup group = StandingGroup::unstable;
    bool settles = false;   ///< stable, and both responses come to rest where they should
    bool within = true;     ///< the limit on Ms that was asked of this entry, if one was
    Figure Ms;              ///< of the loop as it will run: on the worst plant, in the user's own controller
    Figure min_limit;       ///< least limit on the Ms of all entries with which it holds; none where no limit does
    Figure excess_percent;  ///< of the load IAE over the least at the same Ms; by it entries rank
    int order = 0;          ///< from 1: its place where no limit on the Ms of all is set
    std::string why;        ///< what keeps it from the first group; empty where nothing does
    bool holds() const { return group == StandingGroup::holds; }
};

/// A controller with its evaluation, or why there is none.
struct TuningEntry {
    std::string method;  ///< id; "baseline" for today's settings; empty for controllers that were sent
    std::string title;
    std::string source;
    bool over_region = false;  ///< limits hold over the record's confidence region, not on its model alone
    /// Load IAE of an entry over the region, divided by that of the same method on the model alone.
    std::optional<double> region_cost;
    MethodOptions options;  ///< given, over the defaults
    std::optional<Plant> reduced_model;
    std::optional<double> Ms_limit;            ///< that the method was asked for
    std::optional<double> asked_Ms;            ///< the same where the request asked, or the method promises it
    std::optional<double> asked_overshoot;     ///< percent of the step, where the request has one
    Reports reports;                           ///< of the method, and what was asked for of every controller
    std::optional<OptimumAtMs> optimum_at_Ms;  ///< where asked for
    std::optional<double> best_PI_load_IAE;    ///< beside a robust PID: of the robust PI within the same limits
    std::optional<DeviceEntry> on_device;      ///< where asked for and possible
    std::optional<ReplayedEntry> replay;       ///< the recorded time with this controller
    std::optional<Standing> standing;          ///< of what was tuned, and of the baseline
    /// The longest sample time of a program with backward rules that keeps Ms within 5 %; of designs.
    std::optional<Figure> longest_sample_time;
    std::optional<Controller> unjudged;    ///< in place of an evaluation, where there is no plant to judge it on
    std::optional<Evaluation> evaluation;  ///< warnings of the method come first in its list
    std::optional<Error> error;
    std::vector<verdict::Finding> verdict;  ///< the most important first

    /// The report of this type; null if there is none.
    template <class Report>
    const Report* report_as() const {
        return report_among<Report>(reports);
    }
};

/// One horizon for the responses of all entries, ideal and as built, equations' own and their linearisation's.
void draw_together(std::vector<TuningEntry>& entries);

}  // namespace tunewright
