#include "server/jobs/problems.h"

#include <array>
#include <cstdio>

#include "api/problem.h"
#include "engine/error.h"

namespace tunewright::server {

std::string timeout_problem(double timeout_s) {
    std::array<char, 32> seconds{};
    std::snprintf(seconds.data(), seconds.size(), "%.6g", timeout_s);
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = std::string("The job was stopped after timeout_s = ") + seconds.data() +
                    " s. Ask for fewer methods or a simpler search, or raise timeout_s.";
    return api::to_json(api::to_problem(error));
}

std::string given_up_problem(int attempts) {
    return fault_problem("The job was interrupted " + std::to_string(attempts) +
                         " times because the process that computed it ended, and is not tried again. If other jobs "
                         "end well, this one may be the cause: ask for a simpler search. Else post it anew.");
}

std::string fault_problem(const std::string& detail) {
    api::Problem problem;
    problem.status = 500;
    problem.type = "internal";
    problem.title = "Internal Server Error";
    problem.detail = detail;
    return api::to_json(problem);
}

}  // namespace tunewright::server
