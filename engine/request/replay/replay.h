// "What would this hour have looked like?": the recorded hour of a loop with other settings, and the error of that claim.
//
// 1. The record is refused where a replay of it would say nothing of the settings (ReplayRefusal).
// 2. Its rows are put on an even grid, u cut to the actuator's limits (loop_rows.h).
// 3. The controller, as it is implemented where that is known, runs over the hour on the model
//    (simulation/replay/loop_replay.h); its figures stand next to those of the recorded u and y.
// 4. The same on every plant at the ends of the record's 95 % region and on its other structures: the least and the
//    largest ratio of the IAE are the band of the claim.
// 5. An entry is refused where that band is too wide, or a plant of the region escapes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/identification/identify.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/request/entry.h"
#include "engine/request/replay/replay_entry.h"
#include "engine/request/tune.h"
#include "engine/simulation/replay/loop_replay.h"

namespace tunewright {

class RecordReplayer {
public:
    /// What it is made from must outlive it.
    RecordReplayer(const TuningRequest& request, const IdentifiedModel& model);

    /// The hour as it was; `refused` where no entry is replayed.
    const ReplayedRecord& record() const { return record_; }
    /// Empty without a controller, and where the record is refused.
    std::optional<ReplayedEntry> of(const TuningEntry& entry) const;

private:
    std::optional<ReplayRefusal> refusal() const;
    void take_limits();
    void take_plants();
    void choose_shown_rows();
    std::optional<SampledPid> law_of(const TuningEntry& entry) const;
    ProgramLimits limits_of(const TuningEntry& entry) const;
    HourFigures figures_of(const ReplayedRows& run) const;
    HourTrace trace_of(const std::vector<double>& y, const std::vector<double>& u) const;

    const TuningRequest& request_;
    const IdentifiedModel& model_;
    LoopRows rows_;
    ProgramLimits limits_;
    double u_grid_ = 0, band_ = 0;
    std::vector<LinearPlant> plants_;  ///< the model first
    std::vector<std::size_t> shown_;   ///< rows of the traces
    ReplayedRecord record_;
};

}  // namespace tunewright
