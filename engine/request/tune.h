// The main entry point: a tuning request in, a tuning result out. Record -> model -> controllers -> evaluations ->
// ranking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/own_step.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/request/given_controller.h"
#include "engine/request/plan.h"

namespace tunewright {

/// When a method that can hold its limits over the 95 % confidence region of a record's model does so.
enum class IdentifiedRegion {
    where_needed,  ///< if the design for the model alone breaks a limit on the region: then both are answered, the
                   ///< design for the region first
    unused,
    held,
};

/// Result of an experiment with a proportional controller, for a plant that is otherwise unknown.
struct UltimateTest {
    double Ku = 1;            ///< gain at which the loop oscillates, u/y, != 0
    double Pu = 1;            ///< period of that oscillation, > 0
    std::optional<double> K;  ///< static gain, y/u, != 0, with the sign of Ku

    /// An error if the signs of K and Ku differ: a proportional controller makes a plant oscillate only at a gain of
    /// the plant's own sign.
    std::optional<Error> fault() const;
};

struct TuningRequest {
    std::optional<AnalysedPlant> subject;  ///< exactly one of subject, record, model and ultimate
    std::optional<Record> record;
    std::optional<IdentifiedModel> model;  ///< a model that an earlier request identified from a record
    std::optional<UltimateTest> ultimate;
    IdentifyOptions identify;
    std::vector<MethodRequest> tune = {MethodRequest{}};  ///< may be empty if there are `controllers`
    std::vector<GivenController> controllers;             ///< of the user's choice, judged like designs
    std::optional<GivenController> baseline;              ///< today's settings
    EvaluateOptions evaluate;
    verdict::GivenSteps given_steps;  ///< the steps of `evaluate` that the user set
    std::optional<OwnStep> own_step;  ///< simulated with every controller
    std::optional<device::DeviceModel>
        device;  ///< the user's own controller, for which entries are converted and evaluated
    IdentifiedRegion identified_region = IdentifiedRegion::where_needed;
    verdict::Labels labels;  ///< the units in verdicts
};

struct TuningResult {
    std::optional<IdentifiedModel> model;
    std::optional<ReplayedRecord> replay;           ///< the record as it was
    std::optional<OperatingPoint> operating_point;  ///< only for a nonlinear plant
    std::vector<TuningEntry> controllers;
    std::vector<int> ranking;  ///< indices into controllers, best first; entries with an error are left out
    std::string ranking_by;
    std::optional<double> rank_Ms;          ///< the common limit on Ms of the ranking; none if entries are not ranked
    bool partial = false;                   ///< cancelled after a feasible design was found
    std::vector<verdict::Finding> verdict;  ///< the verdict on the whole answer: which entry to take
    std::optional<int> proposed;            ///< the entry to show first; none if no entry has a controller
};

/// Errors: those of identification; of the single method if all fail; invalid_argument; cancelled.
Expected<TuningResult> tune(const TuningRequest& request, const RunControl& control);

}  // namespace tunewright
