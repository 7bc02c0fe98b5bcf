// The verdict on each entry and on the whole answer, and where there is no loop to judge.
#pragma once

#include <vector>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/request/verdict/finding.h"
#include "engine/tuning/method/method.h"

namespace tunewright::verdict {

/// What is the same for all entries of an answer.
struct Context {
    const AnalysedPlant& subject;
    const EvaluateOptions& options;
    Labels labels;
    double sample_time = 0;                  ///< of the user's controller; 0: continuous or not known
    const IdentifiedModel* model = nullptr;  ///< of a record
    const TuningProblem* problem = nullptr;  ///< that methods work on; null: nothing is designed
    GivenSteps given_steps = {};
    RunControl control = {};  ///< of the request: a cure whose search is stopped is none
};

/// Writes every entry's verdict. The first finding says what the loop is, and its level is the entry's; what belongs to
/// it follows by severity and then in the order in which an engineer reads a loop.
void judge(std::vector<TuningEntry>& entries, const Context& context);

/// The verdict on an entry that has no controller: that there is none, and the reason.
std::vector<Finding> no_controller(const Error& error);

/// The verdict on settings from Ku and Pu alone: how they stand to `Ku` (u/y), and the rule's own `remarks`.
std::vector<Finding> without_loop(const Controller& controller, double Ku, const std::vector<Warning>& remarks);

/// The verdict on all of them.
std::vector<Finding> of_all_without_loop();

/// Over all entries, which have their verdicts: which to take, against today's. `ranking`: indices of entries, best
/// first; those left out are not taken. `partial`: somebody stopped the search. Empty without entries.
///
/// Taken is an entry that is not bad, in this order: it keeps the limits that were asked for; its rule is within its
/// validity; no other such entry costs less than a third of its load IAE; its level; its rank.
std::vector<Finding> of_all(const std::vector<TuningEntry>& entries, const std::vector<int>& ranking,
                            const Context& context, bool partial);

/// The entry to show first: the one that the verdict over all names, else the first that has a controller. Empty: none
/// has one.
std::optional<int> proposed(const std::vector<TuningEntry>& entries, const std::vector<Finding>& of_all);

}  // namespace tunewright::verdict
