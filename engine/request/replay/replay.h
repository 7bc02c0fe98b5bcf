// The recorded time of a loop with other settings, and the error of that statement.
//
// 1. A record whose replay would be meaningless is refused (ReplayRefusal).
// 2. The rows are put on an even grid (loop_rows.h).
// 3. The controller, as implemented if that is known, runs over the recorded time on the model
//    (simulation/replay/loop_replay.h). Its figures are compared with those of the recorded u and y.
// 4. The same on every plant at the ends of the record's 95 % region and on its other structures: the least and the
//    largest ratio of the IAE are the band.
// 5. An entry is refused if its band is too wide or its loop is unstable on one of these plants.
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
    /// Request and model must outlive it.
    RecordReplayer(const TuningRequest& request, const IdentifiedModel& model);

    /// The recorded time as it was; `refused` if no entry is replayed.
    const ReplayedRecord& record() const { return record_; }
    /// Empty if the entry has no controller or the record is refused.
    std::optional<ReplayedEntry> of(const TuningEntry& entry) const;

private:
    std::optional<ReplayRefusal> refusal() const;
    void take_limits();
    void take_plants();
    void choose_shown_rows();
    std::optional<SampledPid> law_of(const TuningEntry& entry) const;
    ProgramLimits limits_of(const TuningEntry& entry) const;
    ReplayFigures figures_of(const ReplayedRows& run) const;
    ReplayTrace trace_of(const std::vector<double>& y, const std::vector<double>& u) const;

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
