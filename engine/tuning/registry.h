// All tuning methods, in the order in which they are listed: the only place that names them.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/method/method.h"

namespace tunewright {

/// Every method, in the order in which they are listed.
const std::vector<TuningMethod>& method_registry();

/// The method of a request that gives none: the first in the registry.
const std::string& default_method();

/// Null for an unknown id.
const TuningMethod* find_method(const std::string& id);

}  // namespace tunewright
