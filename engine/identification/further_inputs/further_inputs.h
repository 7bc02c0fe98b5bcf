// Models of the measured inputs beside u, identified together with the plant's.
#pragma once

#include "engine/identification/fit/model_search.h"

namespace tunewright {

/// search_models(), with a lag and a dead time of its own for each of the record's further inputs (CleanRecord::d) that
/// matters; an integrating plant's integrate too.
///
/// 1. The plant alone is searched for. Where the record has no further inputs, that is the answer.
/// 2. Without the drift and the load that step 1 may have found, which may have been the inputs': each input's lag and
///    dead time start from a scan, the inputs before it held, and all are refined with the plant's.
/// 3. What they did is taken off y, and the plant's structures are searched for in the rest, with drift and load; with
///    the best, step 2 once more. Kept where it leaves less.
/// 4. Every structure is refined together with the inputs, and the choice is made again. Drift and load go again where
///    the information criterion without them is no more than 10 above.
/// 5. An input without which the information criterion is no more than 10 above, or that makes less than a thousandth
///    of y's variance, is left out. Where none remains, the answer is that of step 1.
///
/// In the result `context.record.d` are the inputs that matter, in the order of ModelForm::further.
ModelSearch search_with_further(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control);

/// Contribution of further input `k` to y at the record's samples. Needs `fit.linear`.
std::vector<double> further_part(const CleanRecord& record, const Fit& fit, int k);

/// Share of input `k` in the sum of the variances that u and the further inputs made in y, 0 to 1.
double further_share(const CleanRecord& record, const Fit& fit, int k);

/// K, T and L of each further input, one after the other, in the record's units.
std::vector<double> further_parameters(const CleanRecord& record, const ModelForm& form, const ModelShape& shape,
                                       std::span<const double> linear);

/// The models of the further inputs from such parameters and their variances.
std::vector<DisturbanceModel> disturbances_of(const CleanRecord& record, const Fit& fit,
                                              const std::vector<double>& values, const std::vector<double>& variances);

/// Names in the notes the further inputs of the record that the model does without.
void note_further_inputs(const Record& record, IdentifiedModel& model);

}  // namespace tunewright
