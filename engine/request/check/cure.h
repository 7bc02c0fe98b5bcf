// From a loop whose cause is its tuning to new settings, or to the test that is missing for them; from a sticking valve
// to the settings that stop its cycle until it is repaired.
#pragma once

#include <optional>
#include <string>

#include "engine/check/loop_check.h"
#include "engine/check/valve/cycle_stops.h"
#include "engine/controller/pid.h"
#include "engine/plant/plant.h"
#include "engine/progress.h"
#include "engine/request/check/test_plan.h"

namespace tunewright {

struct LoopCure {
    std::optional<IdealPid> settings;        ///< the design that holds its limit on all plants that fit the record
    std::optional<IdealPid> today;           ///< as given, or as the record shows them
    std::optional<Plant> plant;              ///< identified
    Figure worst_Ms;                         ///< of the settings, over the record's 95 % region
    Figure error_ratio;                      ///< mean magnitude of the error in the recorded time, new over old
    std::optional<TestPlan> test;            ///< without settings
    std::optional<check::CycleStops> valve;  ///< with a sticking valve, instead of all but `today`
    std::string detail;  ///< one sentence: what the settings hold, or why the record does not suffice
};

/// Empty where neither tuning nor a valve is the cause. Identification and design take up to some seconds.
std::optional<LoopCure> cure_of(const check::LoopQuestion& question, const check::LoopCheck& check,
                                const RunControl& control);

}  // namespace tunewright
