// All tuning methods, in the order in which they are listed: the one place that names them.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/method/method.h"

namespace tunewright {

/// Every method, in the order in which they are listed. The one place that names them all.
const std::vector<TuningMethod>& method_registry();

/// The method of a request that names none: the first of the registry.
const std::string& default_method();

/// Null if there is none of this id.
const TuningMethod* find_method(const std::string& id);

}  // namespace tunewright
