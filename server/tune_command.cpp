#include "server/tune_command.h"

#include <chrono>
#include <iostream>
#include <memory>

#include "api/service.h"
#include "server/http/problems.h"
#include "server/input_file.h"
#include "server/jobs/timer.h"

namespace tunewright::server {
namespace {

int fail(const std::string& problem_json) {
    std::cerr << problem_json << "\n";
    return 1;
}

int fail(const api::Problem& problem) { return fail(api::to_json(problem)); }

double monotonic_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int tune(const std::string& file) {
    std::string text;
    if (!read_input(file, text)) return fail(http::problem(404, "The file " + file + " cannot be read."));
    const auto prepared = api::prepare_job(text);
    if (const auto* problem = std::get_if<api::Problem>(&prepared)) return fail(*problem);
    const auto& job = std::get<api::PreparedJob>(prepared);

    std::stop_source stop;
    Timer timer;
    timer.after(std::chrono::duration<double>(job.timeout_s), [&stop] { stop.request_stop(); });
    RunControl control;
    control.stop = stop.get_token();
    control.now_ms = monotonic_ms;
    const api::JobOutcome outcome = api::run_job(job.request_json, control);
    timer.stop();
    if (outcome.status == api::JobOutcome::Status::succeeded) {
        std::cout << outcome.result_json << "\n";
        return 0;
    }
    if (!outcome.error_json.empty()) return fail(outcome.error_json);
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = "The computation was stopped after timeout_s. Ask for less, or raise timeout_s.";
    return fail(api::to_problem(error));
}

}  // namespace tunewright::server
