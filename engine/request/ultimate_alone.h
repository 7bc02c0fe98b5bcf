// Settings for a plant of which only the ultimate gain and period are known.
#pragma once

#include "engine/expected.h"
#include "engine/request/tune.h"

namespace tunewright {

/// The rules on Ku and Pu, such as those of Ziegler and Nichols (1942), need no more than what an experiment with a
/// proportional controller shows. Nothing is known of the loop that their settings make: no Ms, margins or responses.
///
/// One entry for each planned row; of method "all" only for the rules that take Ku and Pu. They stand in the order of
/// the methods.
///
/// | member | holds |
/// | --- | --- |
/// | `unjudged` | the rule's controller |
/// | `verdict` | robustness-unknown with Kp/Ku; behind it the rule's remarks, where K is known |
/// | `error` | of a method by name that needs a model, or the static gain |
///
/// A rule takes Ku and Pu as its own options, on a stand-in plant with the static gain K. Where K is not given it runs
/// on two such plants, and if its settings differ the entry is an error: the rule needs K.
///
///     TuningRequest request;
///     request.ultimate = UltimateTest{0.903, 30.5};
///     request.tune = {{"ziegler_nichols_ultimate", {}}};  // Kp 0.542, Ti 15.25, Td 3.81
///
/// Errors: as tune(); of the methods where all fail.
Expected<TuningResult> tune_on_ultimate(const TuningRequest& request);

}  // namespace tunewright
