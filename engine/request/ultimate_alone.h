// Settings for a plant when only its ultimate gain and period are known.
#pragma once

#include "engine/expected.h"
#include "engine/request/tune.h"

namespace tunewright {

/// The rules on Ku and Pu, such as those of Ziegler and Nichols (1942), need only the result of an experiment with a
/// proportional controller. The loop with their settings remains unknown: no Ms, margins or responses.
///
/// One entry for each planned row; of method "all" only for the rules that take Ku and Pu. The entries have the order
/// of the methods.
///
/// | member | holds |
/// | --- | --- |
/// | `unjudged` | the rule's controller |
/// | `verdict` | robustness-unknown with Kp/Ku; then the rule's remarks, if K is known |
/// | `error` | for a named method that needs a model or the static gain |
///
/// A rule takes Ku and Pu as its own options, on a stand-in plant with the static gain K. Without K it runs on two such
/// plants; if the two settings differ, the rule needs K and the entry is an error.
///
///     TuningRequest request;
///     request.ultimate = UltimateTest{0.903, 30.5};
///     request.tune = {{"ziegler_nichols_ultimate", {}}};  // Kp 0.542, Ti 15.25, Td 3.81
///
/// Errors: as tune(); those of the methods if all fail.
Expected<TuningResult> tune_on_ultimate(const TuningRequest& request);

}  // namespace tunewright
