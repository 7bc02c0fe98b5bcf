// A store around another one that measures each operation.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "server/store/store.h"

namespace tunewright::server {

/// `meter` runs on the thread on which the operation ends: its name, the seconds from the call to the answer, and
/// whether the store succeeded.
using StoreMeter = std::function<void(std::string_view operation, double seconds, bool done)>;

std::unique_ptr<JobStore> metered(std::unique_ptr<JobStore> store, StoreMeter meter);

}  // namespace tunewright::server
