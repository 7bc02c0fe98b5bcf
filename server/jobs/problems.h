// Why a job failed that its computation did not fail: problem objects, ready for the store.
#pragma once

#include <string>

namespace tunewright::server {

/// Its time was over.
std::string timeout_problem(double timeout_s);
/// Its process died or was stopped that many times.
std::string given_up_problem(int attempts);
/// A fault of the service itself; `detail` tells nothing of its insides.
std::string fault_problem(const std::string& detail);

}  // namespace tunewright::server
