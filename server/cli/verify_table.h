// The answer of `tunewright verify` for a person at a terminal.
#pragma once

#include <string>

#include "api/contract/result/verify_call.h"

namespace tunewright::server {

/// The counts, the largest difference of each kind of figure, every figure that differs, and what has no second
/// computation.
std::string verify_table(const api::VerifyAnswer& answer);

}  // namespace tunewright::server
