// What to do first about a loop, by its cause, and whose work it is.
#pragma once

#include "engine/check/loop_check.h"

namespace tunewright::check {

Action action_for(const LoopCheck& check);

}  // namespace tunewright::check
