// The one entry: a tuning request in, a tuning result out. Record -> model -> controllers -> evaluations -> ranking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/operating_point.h"
#include "engine/evaluation/tradeoff_entry.h"
#include "engine/identification/identify.h"
#include "engine/progress.h"
#include "engine/request/optimum_at_ms.h"
#include "engine/request/plan.h"
#include "engine/request/rimc_entry.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// Whether methods that can hold their limits over the 95 % confidence region of a record's model do so.
enum class IdentifiedRegion {
    where_needed,  ///< where the design on the model alone breaks a limit there: then both are answered, this one first
    unused,
    held,
};

struct TuningRequest {
    std::optional<PlantModel> plant;  ///< exactly one of plant and record
    std::optional<Record> record;
    IdentifyOptions identify;
    std::vector<MethodRequest> tune = {MethodRequest{}};
    std::optional<Controller> baseline;
    EvaluateOptions evaluate;
    IdentifiedRegion identified_region = IdentifiedRegion::where_needed;
};

/// One line of the answer: a method's controller with its evaluation, or why there is none.
struct TuningEntry {
    std::string method;  ///< "baseline" for today's settings
    std::string title;
    std::string source;
    bool over_region = false;  ///< limits hold over the record's confidence region, not on its model alone
    MethodOptions options;     ///< given, over the defaults
    std::optional<Plant> reduced_model;
    std::optional<CostSurface> surface;
    std::optional<RimcEntry> rimc;
    std::optional<OptimumAtMs> optimum_at_Ms;  ///< where asked for
    std::optional<TradeoffEntry> tradeoff;
    std::optional<EmulationReport> emulation;
    std::optional<Evaluation> evaluation;  ///< warnings of the method come first in its list
    std::optional<Error> error;
};

struct TuningResult {
    std::optional<IdentifiedModel> model;
    std::optional<OperatingPoint> operating_point;  ///< of a nonlinear plant
    std::vector<TuningEntry> controllers;
    std::vector<int> ranking;  ///< indices into controllers, best first; entries with an error are left out
    std::string ranking_by;
    bool partial = false;  ///< cancelled after a feasible design was found
};

/// Errors: those of identification; of the single method if all fail; invalid_argument; cancelled.
Expected<TuningResult> tune(const TuningRequest& request, const RunControl& control);

}  // namespace tunewright
