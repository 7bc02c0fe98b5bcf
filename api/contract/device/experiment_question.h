// A test that a controller runs by itself, as asked for: the settings of its program.
#pragma once

#include "api/describe/description.h"
#include "engine/code/experiment/experiment.h"
#include "engine/code/print.h"

namespace tunewright::api {

/// Times in seconds, u and y in the units of the signals.
struct ExperimentQuestion : code::ExperimentOptions {
    code::Experiment experiment = code::Experiment::relay;
    code::Language language = code::Language::structured_text;
};

/// Reading applies the engine's checks; an error becomes a fault of the member that it names.
const Description<ExperimentQuestion>& experiment_contract();

}  // namespace tunewright::api
