// Reasons for which a job fails without its computation: problem objects as JSON, ready for the store.
#pragma once

#include <string>

namespace tunewright::server {

/// The job's time, `timeout_s` seconds, was over.
std::string timeout_problem(double timeout_s);
/// The process that computed it died or was stopped `attempts` times.
std::string given_up_problem(int attempts);
/// A fault of the service itself. `detail` is for the client and shows nothing of the program's inside.
std::string fault_problem(const std::string& detail);

}  // namespace tunewright::server
