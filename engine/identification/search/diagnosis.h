// Warnings that a user should know before trusting a fitted model, with figures.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/identification/fit/output_error.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// The chosen fit with its figures in the record's units.
struct Diagnosis {
    bool settled = false;  ///< the model's remaining movement at the end is below 5 % of its movement so far
    std::vector<Warning> warnings;
};

/// Codes: unsettled-record, structured-residuals, uncertain-parameters, not-at-rest, coarse-quantisation,
/// undersampled-response, looks-integrating, outliers, rows-dropped. `fit` is of all samples of `record`; `values` and
/// `standard_errors` are its plant's (FittedPlant), in the record's units, with the same names.
Diagnosis diagnose(const CleanRecord& record, const Fit& fit, const std::map<std::string, double>& values,
                   const std::map<std::string, double>& standard_errors, const DataQuality& quality);

/// True if y responds to u by more than noise: n ln(sse of a constant/sse) must exceed the cost of the parameters, (p -
/// 1) ln n, by 30, with n the number of independent samples; or the fit must leave less than a tenth of y's variance.
bool responds(const CleanRecord& record, const Fit& fit);

}  // namespace tunewright
