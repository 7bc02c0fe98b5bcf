// What a user should know before trusting a fitted model: sentences with figures.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/identification/fit/output_error.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// The chosen fit in the words of the record.
struct Diagnosis {
    bool settled = false;  ///< the model's remaining movement at the end is below 5 % of what it has moved
    std::vector<Warning> warnings;
};

/// Codes: unsettled-record, structured-residuals, uncertain-parameters, not-at-rest, coarse-quantisation,
/// undersampled-response, looks-integrating, outliers, rows-dropped. `fit` is of all samples of `record`; `values` and
/// `standard_errors` are its plant's (FittedPlant), in the record's units, with the same names.
Diagnosis diagnose(const CleanRecord& record, const Fit& fit, const std::map<std::string, double>& values,
                   const std::map<std::string, double>& standard_errors, const DataQuality& quality);

/// Whether y responds to u beyond what noise explains: n ln(sse of a constant/sse) must exceed the price of the
/// parameters, (p - 1) ln n, by 30, n being the number of independent samples; or the fit must leave less than a tenth
/// of y's variance.
bool responds(const CleanRecord& record, const Fit& fit);

}  // namespace tunewright
