// A program as a file in its language.
#pragma once

#include "api/code/code.h"
#include "api/code/parameters.h"
#include "engine/code/print.h"

namespace tunewright::api {

ControllerCode printed(const code::Program& program, code::Language language, const code::Provenance& provenance,
                       const SampleTime& sample_time);

}  // namespace tunewright::api
