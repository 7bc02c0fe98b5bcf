#include "server/commands.h"

#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "api/report/report.h"
#include "server/clock.h"
#include "server/config.h"
#include "server/http/app/problems.h"
#include "server/jobs/timer.h"
#include "server/json_text.h"

namespace tunewright::server {
namespace {

/// All of the file, or of standard input for "-". Returns false where it cannot be read.
bool read_input(const std::string& file, std::string& text) {
    if (file == "-") {
        text.assign(std::istreambuf_iterator<char>(std::cin), {});
        return true;
    }
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) return false;
    const std::streamoff size = stream.tellg();
    if (size < 0) {  // a pipe has no size
        stream.clear();
        text.assign(std::istreambuf_iterator<char>(stream), {});
        return !stream.bad();
    }
    text.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(text.data(), size);
    return static_cast<bool>(stream);
}

api::Problem unreadable(const std::string& file) { return http::problem(404, "The file " + file + " cannot be read."); }

int fail(const std::string& problem_json) {
    std::cerr << problem_json << "\n";
    return 1;
}

int fail(const api::Problem& problem) { return fail(api::to_json(problem)); }

// A request is one JSON object; a log may have one in each line.
bool is_request(const std::string& text) {
    constexpr const char* kBlank = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string::npos || text[first] != '{') return false;
    const std::size_t end = text.find('\n', first);
    if (end == std::string::npos) return true;
    const std::size_t last = text.find_last_not_of(kBlank, end), next = text.find_first_not_of(kBlank, end);
    return !(text[last] == '}' && next != std::string::npos && text[next] == '{');
}

}  // namespace

int tune(const std::string& file) {
    std::string text;
    if (!read_input(file, text)) return fail(unreadable(file));
    const auto prepared = api::prepare_job(text);
    if (const auto* problem = std::get_if<api::Problem>(&prepared)) return fail(*problem);
    const auto& job = std::get<api::PreparedJob>(prepared);

    std::stop_source stop;
    Timer timer;
    timer.after(std::chrono::duration<double>(job.timeout_s), [&stop] { stop.request_stop(); });
    RunControl control;
    control.stop = stop.get_token();
    control.now_ms = monotonic_ms;
    const api::JobOutcome outcome = api::run_job(job, control);
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

int identify(const IdentifyCommand& command) {
    std::string text;
    if (!read_input(command.file, text)) return fail(unreadable(command.file));
    const api::Answer answer =
        is_request(text) ? api::identify_call(text, {}) : api::identify_csv(std::move(text), command.question, {});
    const bool failed = answer.status >= 400;
    (failed ? std::cerr : std::cout) << answer.body << "\n";
    return failed ? 1 : 0;
}

int plant(const PlantCommand& command) {
    std::string text = command.text;
    if (text == "-") read_input("-", text);
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    const std::string units = std::move(JsonObject().text("time", command.time_unit)).str();
    const std::string question = std::move(JsonObject().raw("units", units).text("text", text)).str();
    const api::Answer answer = api::parse_plant_call(question);
    const bool failed = answer.status >= 400;
    (failed ? std::cerr : std::cout) << answer.body << "\n";
    return failed ? 1 : 0;
}

int code(const CodeCommand& command) {
    std::string result, request;
    if (!read_input(command.file, result)) return fail(unreadable(command.file));
    if (!command.request.empty() && !read_input(command.request, request)) return fail(unreadable(command.request));
    const auto written = api::controller_code({result, request}, command.controller, command.words);
    if (const auto* problem = std::get_if<api::Problem>(&written)) return fail(*problem);
    std::cout << std::get<api::ControllerCode>(written).text;
    return 0;
}

int report(const ReportCommand& command) {
    std::string result, request;
    if (!read_input(command.file, result)) return fail(unreadable(command.file));
    if (!command.request.empty() && !read_input(command.request, request)) return fail(unreadable(command.request));
    const auto written = api::report_html({result, request}, command.controller, {});
    if (const auto* problem = std::get_if<api::Problem>(&written)) return fail(*problem);
    std::cout << std::get<std::string>(written);
    return 0;
}

}  // namespace tunewright::server
