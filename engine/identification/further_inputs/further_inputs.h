// Models of further measured inputs, identified together with the plant.
#pragma once

#include "engine/identification/search/model_search.h"

namespace tunewright {

/// search_models(), with a lag and a dead time for each of the record's further inputs (CleanRecord::d) that matters;
/// if the plant integrates, their models integrate too.
///
/// 1. Search the plant alone. If the record has no further inputs, that is the result.
/// 2. Without the drift and the load of step 1, which may be due to the inputs: start each input's lag and
///    dead time from a scan with the previous inputs fixed, and refine all together with the plant's.
/// 3. Subtract their effect from y, and search the plant's structures in the remainder, with drift and load; with
///    the best, repeat step 2. Keep the result if its residual is smaller.
/// 4. Refine every structure together with the inputs, and repeat the choice. Remove drift and load if
///    the information criterion without them is at most 10 higher.
/// 5. Remove an input without which the information criterion is at most 10 higher, or that causes less than a
///    thousandth of y's variance. If none remains, the result is that of step 1.
///
/// In the result `context.record.d` are the inputs that matter, in the order of ModelForm::further.
ModelSearch search_with_further(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control);

/// Contribution of further input `k` to y at the record's samples. Needs `fit.linear`.
std::vector<double> further_part(const CleanRecord& record, const Fit& fit, int k);

/// Share of input `k` in the sum of the variances of y due to u and to the further inputs, 0 to 1.
double further_share(const CleanRecord& record, const Fit& fit, int k);

/// K, T and L of each further input, one after the other, in the record's units.
std::vector<double> further_parameters(const CleanRecord& record, const ModelForm& form, const ModelShape& shape,
                                       std::span<const double> linear);

/// The models of the further inputs from such parameters and their variances.
std::vector<DisturbanceModel> disturbances_of(const CleanRecord& record, const Fit& fit,
                                              const std::vector<double>& values, const std::vector<double>& variances);

/// Adds a note that names the further inputs of the record that the model does not include.
void note_further_inputs(const Record& record, IdentifiedModel& model);

}  // namespace tunewright
