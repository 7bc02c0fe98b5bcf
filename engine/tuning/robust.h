// Robust design: the least IAE of a load step under limits on Ms and Mt (Garpinger and Hagglund 2008).
#pragma once

#include "engine/tuning/method.h"

namespace tunewright {

TuningMethod robust_method();

}  // namespace tunewright
