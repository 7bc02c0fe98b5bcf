// What to do first about a loop, by its cause, and whose work it is.
#pragma once

#include "engine/check/loop_check.h"

namespace tunewright::check {

/// `source`: the tag of the loop that disturbs this one; empty: unknown.
Action action_for(const LoopCheck& check, const std::string& source = {});

}  // namespace tunewright::check
