// The verdict on each entry and on the whole answer, also for entries without a loop to evaluate.
#pragma once

#include <vector>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/own_step.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/request/verdict/finding.h"
#include "engine/tuning/method/method.h"

namespace tunewright::verdict {

/// The inputs that all entries of an answer share.
struct Context {
    const AnalysedPlant& subject;
    const EvaluateOptions& options;
    Labels labels;
    double sample_time = 0;                  ///< of the user's controller; 0: continuous or unknown
    const IdentifiedModel* model = nullptr;  ///< the model that was identified from a record; null: none
    const TuningProblem* problem = nullptr;  ///< the input of the methods; null: nothing is designed
    GivenSteps given_steps = {};
    RunControl control = {};            ///< of the request: a stopped search gives no cure
    const OwnStep* own_step = nullptr;  ///< null: the request has none
};

/// Writes every entry's verdict. The first finding is the main statement on the loop, and its level is the entry's. The
/// others follow by severity, and then in the order in which an engineer examines a loop.
void judge(std::vector<TuningEntry>& entries, const Context& context);

/// The verdict on an entry without a controller, with the reason.
std::vector<Finding> no_controller(const Error& error);

/// The verdict on settings from Ku and Pu alone: their gain relative to `Ku` (u/y), and the rule's own `remarks`.
std::vector<Finding> without_loop(const Controller& controller, double Ku, const std::vector<Warning>& remarks);

/// The verdict on the whole answer to Ku and Pu alone.
std::vector<Finding> of_all_without_loop();

/// The verdict on all entries, which have their own verdicts already: which one to choose, compared with today's
/// settings. `ranking`: indices of entries, best first; entries that are not in it are not chosen. `partial`: the
/// search was stopped. Empty without entries.
///
/// The chosen entry is not bad, and comes first in this order: it keeps the requested limits; its rule is within its
/// validity; no other such entry costs less than a third of its load IAE; its level; its rank.
std::vector<Finding> of_all(const std::vector<TuningEntry>& entries, const std::vector<int>& ranking,
                            const Context& context, bool partial);

/// The entry to show first: the one that the verdict on the whole names, else the first that has a controller. Empty if
/// none has one.
std::optional<int> proposed(const std::vector<TuningEntry>& entries, const std::vector<Finding>& of_all);

}  // namespace tunewright::verdict
