// Settings by a tuning method, for problems of the library.
#pragma once

#include <string>

#include "engine/score/score.h"
#include "engine/tuning/method/method.h"

namespace tunewright::score {

/// True if the method can design the structure: its option `controller`, where it has one, has this word.
bool designs(const TuningMethod& method, const MethodOptions& given, CertifiedStructure structure);

/// The settings that the method gives for a problem. Options that the request leaves open follow the problem:
/// `controller` its structure, `Ms` and `Mt` its limits, `filter/Tf` its filter.
SettingsFor settings_by(const TuningMethod& method, const MethodOptions& given, const RunControl& control);

}  // namespace tunewright::score
