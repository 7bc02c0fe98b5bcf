#include "server/cli/commands.h"

#include <httplib.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "api/certificate/certificate_call.h"
#include "api/code/experiment_code.h"
#include "api/examples/examples.h"
#include "api/registries.h"
#include "api/report/report.h"
#include "api/report/terminal/terminal.h"
#include "api/service.h"
#include "api/services/verify/verify_call.h"
#include "server/cli/verify_table.h"
#include "server/clock.h"
#include "server/config.h"
#include "server/json_text.h"
#include "server/threads/spare_cores.h"
#include "server/threads/timer.h"

namespace tunewright::server {

namespace {

/// The spare cores for the one computation of a command.
struct AllCores {
    SpareCores cores{core_count()};
    SpareCores::Computation computation{cores};
};

/// The result as JSON, or the problem as JSON.
struct Tuned {
    bool succeeded = false;
    std::string json;
};

Tuned tuned(const api::PreparedJob& job) {
    std::stop_source stop;
    Timer timer;
    timer.after(std::chrono::duration<double>(job.timeout_s), [&stop] { stop.request_stop(); });
    AllCores all;
    RunControl control;
    control.stop = stop.get_token();
    control.now_ms = monotonic_ms;
    control.spread = all.computation.spread();
    api::JobOutcome outcome = api::run_job(job, control);
    timer.stop();
    if (outcome.status == api::JobOutcome::Status::succeeded) return {true, std::move(outcome.result_json)};
    if (!outcome.error_json.empty()) return {false, std::move(outcome.error_json)};
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = "The computation was stopped after timeout_s. Reduce the request, or raise timeout_s.";
    return {false, api::to_json(api::to_problem(error))};
}

int answered(const api::Answer& answer, const OutputWords& words, const Table& table, const std::string& file = "") {
    return answer.status >= 400 ? write_problem(answer.body, words, file) : write_answer(answer.body, words, table);
}

int write_drawing(const std::string& file, const std::string& drawing, const OutputWords& words) {
    std::ofstream stream(file, std::ios::binary);
    stream << drawing;
    stream.close();
    if (stream) return 0;
    api::Problem problem{500, "not-written", "The drawing cannot be written", {}, {}, {}};
    problem.detail = "The drawing cannot be written to " + file + ": " + std::strerror(errno) + ".";
    return write_problem(problem, words);
}

/// Draws the requested plots; stops at the first problem.
int draw(const TuneCommand& command, const std::string& result, const std::string& request) {
    const api::ResultSource source{result, request};
    if (command.plot) {
        const auto drawn = api::responses_text(source, "");
        if (const auto* problem = std::get_if<api::Problem>(&drawn)) return write_problem(*problem, command.output);
        std::cout << "\n" << std::get<std::string>(drawn);
    }
    if (command.svg.empty()) return 0;
    const auto drawn = api::responses_svg(source, "");
    if (const auto* problem = std::get_if<api::Problem>(&drawn)) return write_problem(*problem, command.output);
    return write_drawing(command.svg, std::get<std::string>(drawn), command.output);
}

/// Reads the texts of a result's file and of its request's. If one of them is not valid, writes the problem and returns
/// its exit code.
std::optional<int> read_texts(const ResultWords& words, std::string& result, std::string& request) {
    if (!read_input(words.file, result)) return write_problem(unreadable(words.file), {});
    if (words.request.empty()) return std::nullopt;
    if (!read_input(words.request, request)) return write_problem(unreadable(words.request), {});
    auto kept = api::request_of_result(result, request);
    if (const auto* problem = std::get_if<api::Problem>(&kept)) return write_problem(*problem, {}, words.request);
    request = std::move(std::get<std::string>(kept));
    return std::nullopt;
}

}  // namespace

int tune(const TuneCommand& command) {
    std::string text;
    if (!command.file.empty() && !read_input(command.file, text))
        return write_problem(unreadable(command.file), command.output);
    api::TuneWords words = command.words;
    if (command.all) words.methods = {"all"};
    auto request = api::tuning_request(words, command.file.empty() ? std::nullopt : std::optional(std::move(text)));
    if (const auto* problem = std::get_if<api::Problem>(&request))
        return write_problem(*problem, command.output, command.file);
    const std::string& asked = std::get<std::string>(request);
    const auto prepared = api::prepare_job(asked);
    if (const auto* problem = std::get_if<api::Problem>(&prepared))
        return write_problem(*problem, command.output, command.file);
    const Tuned answer = tuned(std::get<api::PreparedJob>(prepared));
    if (!answer.succeeded) return write_problem(answer.json, command.output, command.file);
    OutputWords output = command.output;
    output.table = output.table || command.plot;
    const std::string& kept = std::get<api::PreparedJob>(prepared).request_json;
    const int written =
        command.with_request
            ? write_answer(std::move(JsonObject().raw("request", kept).raw("result", answer.json)).str(), output)
            : write_answer(answer.json, output, api::result_text);
    return written != 0 ? written : draw(command, answer.json, asked);
}

int answer_request(const RequestCommand& command) {
    std::string text;
    if (!read_input(command.file, text)) return write_problem(unreadable(command.file), command.output);
    const bool about_range = command.structure.empty();
    const auto prepared = about_range ? api::prepare_range(text) : api::prepare_structure(text, command.structure);
    if (const auto* problem = std::get_if<api::Problem>(&prepared))
        return write_problem(*problem, command.output, command.file);
    const Tuned answer = tuned(std::get<api::PreparedJob>(prepared));
    if (!answer.succeeded) return write_problem(answer.json, command.output, command.file);
    return write_answer(answer.json, command.output, about_range ? api::range_text : api::structure_text);
}

int identify(const IdentifyCommand& command) {
    std::string text;
    if (!read_input(command.file, text)) return write_problem(unreadable(command.file), command.output);
    AllCores all;
    RunControl control;
    control.spread = all.computation.spread();
    const auto request = api::request_text(text);
    const api::Answer answer =
        request ? api::identify_call(*request, control) : api::identify_csv(std::move(text), command.question, control);
    return answered(answer, command.output, api::model_text, command.file);
}

int controller_record(const ControllerRecordCommand& command) {
    std::string text;
    if (!read_input(command.file, text)) return write_problem(unreadable(command.file), command.output);
    const auto request = api::request_text(text);
    const std::string asked = request ? *request : api::controller_record_request(command.question, text);
    return answered(api::controller_record_call(asked, {}), command.output, {}, command.file);
}

int score(const ScoreCommand& command) {
    std::optional<std::string> file;
    if (!command.file.empty() && !read_input(command.file, file.emplace()))
        return write_problem(unreadable(command.file), command.output);
    AllCores all;
    RunControl control;
    control.spread = all.computation.spread();
    return answered(api::score_call(api::score_request(command.words, file), control), command.output, api::score_text,
                    command.file);
}

int plant(const PlantCommand& command) {
    std::string text = command.text;
    if (text == "-") read_input("-", text);
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    const std::string units = std::move(JsonObject().text("time", command.time_unit)).str();
    const std::string question = std::move(JsonObject().raw("units", units).text("text", text)).str();
    return answered(api::parse_plant_call(question), command.output, {});
}

int code(const CodeCommand& command) {
    std::string result, request;
    if (command.experiment) {
        const auto written = api::experiment_code(command.words);
        if (const auto* problem = std::get_if<api::Problem>(&written)) return write_problem(*problem, {});
        return write_text(std::get<api::ControllerCode>(written).text);
    }
    if (command.result.file.empty()) {
        std::cerr << "code: give a file with a result, or --experiment relay or bump.\n";
        return 2;
    }
    if (const auto refused = read_texts(command.result, result, request)) return *refused;
    const auto written = api::controller_code({result, request}, command.result.controller, command.words);
    if (const auto* problem = std::get_if<api::Problem>(&written))
        return write_problem(*problem, {}, command.result.file);
    return write_text(std::get<api::ControllerCode>(written).text);
}

int certificate(const ResultWords& command) {
    std::string result, request;
    if (const auto refused = read_texts(command, result, request)) return *refused;
    AllCores all;
    RunControl control;
    control.spread = all.computation.spread();
    const auto written = api::certificate_file({result, request}, command.controller, control);
    if (const auto* problem = std::get_if<api::Problem>(&written)) return write_problem(*problem, {}, command.file);
    return write_text(std::get<std::string>(written));
}

int verify(const VerifyCommand& command) {
    std::string result, request;
    if (const auto refused = read_texts(command.result, result, request)) return *refused;
    const auto verified = api::verify_result({result, request}, {});
    if (const auto* problem = std::get_if<api::Problem>(&verified))
        return write_problem(*problem, command.output, command.result.file);
    const auto& answer = std::get<api::VerifyAnswer>(verified);
    const int written = write_answer(api::verify_json(answer), command.output,
                                     [&answer](std::string_view) { return verify_table(answer); });
    return answer.differing() > 0 ? 1 : written;
}

int report(const ResultWords& command) {
    std::string result, request;
    if (const auto refused = read_texts(command, result, request)) return *refused;
    const auto written = api::report_html({result, request}, command.controller, {});
    if (const auto* problem = std::get_if<api::Problem>(&written)) return write_problem(*problem, {}, command.file);
    return write_text(std::get<std::string>(written));
}

int methods(const ListCommand& command) {
    if (!command.name.empty()) return answered(api::method_json(command.name), command.output, {});
    return write_answer(api::methods_json(), command.output, api::methods_text);
}

int controllers(const ListCommand& command) {
    if (!command.name.empty()) return answered(api::controller_json(command.name), command.output, {});
    return write_answer(api::controllers_json(), command.output, api::controllers_text);
}

int examples(const ListCommand& command) {
    if (!command.name.empty()) return answered(api::example_request(command.name), command.output, {});
    return write_answer(api::examples_json(), command.output, api::examples_text);
}

namespace {

constexpr int kPatienceSeconds = 3;

struct Target {
    HostPort address;
    std::string path = "/";
};

Target parse_url(const std::string& url) {
    constexpr std::string_view scheme = "http://";
    const char* const rule = "it must be http://HOST:PORT/PATH.";
    if (!url.starts_with(scheme)) throw std::invalid_argument(rule);
    const std::size_t slash = std::min(url.find('/', scheme.size()), url.size());
    Target target;
    try {
        target.address = parse_listen(url.substr(scheme.size(), slash - scheme.size()));
    } catch (const std::invalid_argument&) {
        throw std::invalid_argument(rule);
    }
    if (slash < url.size()) target.path = url.substr(slash);
    return target;
}

int failed(int code, const std::string& url, const std::string& why) {
    std::cerr << "tunewright: " << url << ": " << why << "\n";
    return code;
}

}  // namespace

int check_health(const std::string& url) {
    try {
        const Target target = parse_url(url);
        httplib::Client client(target.address.host, target.address.port);
        client.set_connection_timeout(kPatienceSeconds);
        client.set_read_timeout(kPatienceSeconds);
        const httplib::Result answer = client.Get(target.path);
        if (!answer) return failed(1, url, "nothing answers there (" + httplib::to_string(answer.error()) + ")");
        return answer->status == 200 ? 0 : failed(1, url, "it answers " + std::to_string(answer->status));
    } catch (const std::invalid_argument& error) {
        return failed(2, url, error.what());
    }
}

std::string health_url(const std::string& listen) {
    HostPort address = parse_listen(listen);
    if (address.host == "0.0.0.0") address.host = "127.0.0.1";
    if (address.host == "::") address.host = "::1";
    const bool v6 = address.host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port) + "/healthz";
}

}  // namespace tunewright::server
