// The one entry: a tuning request in, a tuning result out. Record -> model -> controllers -> evaluations -> ranking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/request/plan.h"

namespace tunewright {

/// Whether methods that can hold their limits over the 95 % confidence region of a record's model do so.
enum class IdentifiedRegion {
    where_needed,  ///< where the design on the model alone breaks a limit there: then both are answered, this one first
    unused,
    held,
};

/// Result of an experiment with a proportional controller, for a plant of which nothing else is known.
struct UltimateTest {
    double Ku = 1;            ///< gain at which the loop oscillates, u/y, != 0
    double Pu = 1;            ///< period of that oscillation, > 0
    std::optional<double> K;  ///< static gain, y/u, != 0, of the sign of Ku

    /// The fault of the signs, if there is one: a proportional controller makes a plant oscillate at a gain of the
    /// plant's own sign.
    std::optional<Error> fault() const;
};

struct TuningRequest {
    std::optional<AnalysedPlant> subject;  ///< exactly one of subject, record, model and ultimate
    std::optional<Record> record;
    std::optional<IdentifiedModel> model;  ///< what an earlier request found in its record
    std::optional<UltimateTest> ultimate;
    IdentifyOptions identify;
    std::vector<MethodRequest> tune = {MethodRequest{}};
    std::optional<Controller> baseline;
    EvaluateOptions evaluate;
    verdict::GivenSteps given_steps;  ///< those of `evaluate` that the user names
    struct TypedSettings {
        device::DeviceModel device;
        product::Settings settings;
    };
    std::optional<TypedSettings> baseline_settings;  ///< whose ideal twin `baseline` is
    std::optional<device::DeviceModel> device;  ///< the user's own controller, for which entries are settled and judged
    IdentifiedRegion identified_region = IdentifiedRegion::where_needed;
    verdict::Labels labels;  ///< in which verdicts speak
};

struct TuningResult {
    std::optional<IdentifiedModel> model;
    std::optional<ReplayedRecord> replay;           ///< a record as it was
    std::optional<OperatingPoint> operating_point;  ///< of a nonlinear plant
    std::vector<TuningEntry> controllers;
    std::vector<int> ranking;  ///< indices into controllers, best first; entries with an error are left out
    std::string ranking_by;
    std::optional<double> rank_Ms;  ///< the limit on the Ms of all that ranking goes by; none where nothing ranks them
    bool partial = false;           ///< cancelled after a feasible design was found
    std::vector<verdict::Finding> verdict;  ///< over all entries: which to take
    std::optional<int> proposed;            ///< the entry to show first; none where no entry has a controller
};

/// Errors: those of identification; of the single method if all fail; invalid_argument; cancelled.
Expected<TuningResult> tune(const TuningRequest& request, const RunControl& control);

}  // namespace tunewright
