// A record in, a plant out.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/record.h"
#include "engine/plant/plant.h"
#include "engine/progress.h"
#include "engine/warning.h"

namespace tunewright {

enum class ModelChoice { automatic, fopdt, sopdt, sopdt_zero, ipdt, ipdt_lag };
enum class IdentifyMethod { automatic, relay_fourier, output_error, two_point };

struct IdentifyOptions {
    ModelChoice model = ModelChoice::automatic;
    IdentifyMethod method = IdentifyMethod::automatic;
    std::optional<double> shift;  ///< Liu-Gao's alpha (Eq. 9), 1/time
};

struct Candidate {
    Plant plant;
    double fit_percent = 0;  ///< 100 (1 - ||y - yhat||/||y - mean(y)||), free run, offset estimated
    double criterion = 0;    ///< information criterion, smaller is better
    std::map<std::string, double> standard_errors;  ///< by parameter symbol; robust to autocorrelated residuals
};

/// The chosen model beside the record: for the plot.
struct FitTrace {
    std::vector<double> t, y, y_model;
};

/// What was found in the record and what was done about it. Named figures, sentences beside them.
struct DataQuality {
    int samples = 0;
    double sample_time = 0;  ///< median spacing
    bool irregular = false;
    double noise_std = 0;     ///< of y, high-frequency part
    double quantisation = 0;  ///< step of y's grid, 0 if none found
    int steps = 0;            ///< changes of u
    bool settled = false;
    int samples_dropped = 0;  ///< repeated or backward times, non-numbers
    std::vector<std::string> notes;
};

struct IdentifiedModel {
    Plant plant;
    double fit_percent = 0;
    std::vector<Candidate> candidates;
    std::map<std::string, double> standard_errors;
    std::string choice_reason;  ///< why this structure, one sentence
    FitTrace fit;
    DataQuality data_quality;
    std::vector<Warning> warnings;
};

/// Output-error least squares with continuous dead time and free offset. Errors: not_identifiable, with the cure;
/// invalid_argument.
Expected<IdentifiedModel> identify(const Record& record, const IdentifyOptions& options, const RunControl& control);

}  // namespace tunewright
