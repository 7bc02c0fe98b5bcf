#include "api/services/score_service.h"

#include <algorithm>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include "api/certificate/problem_library.h"
#include "api/contract/score/score_call.h"
#include "api/csv/cell.h"
#include "api/csv/table.h"
#include "api/describe/body.h"
#include "engine/score/rule_settings.h"
#include "engine/tuning/registry.h"

namespace tunewright::api {
namespace {

std::variant<ScoreAnswer, Problem> scored(const std::vector<score::Problem>& problems, const std::string& name,
                                          const score::SettingsFor& settings, const RunControl& control) {
    if (problems.empty())
        return to_problem(Error{ErrorKind::invalid_argument, "problems",
                                "No problem of the library is meant. See docs/problems.md for their names."});
    auto found = score::score(problems, settings, control);
    if (found) return ScoreAnswer{name, std::move(*found)};
    Error error = found.error();
    if (!error.where.empty()) error.where = "tune/" + error.where;
    return to_problem(error);
}

std::variant<ScoreAnswer, Problem> of_rule(const ScoreRequest& request, const RunControl& control) {
    const TuningMethod& method = *find_method(request.tune->method);
    std::vector<score::Problem> problems;
    for (const score::Problem& problem : problem_library())
        if (request.problems.admits(problem) &&
            (request.problems.structure || score::designs(method, request.tune->options, problem.structure)))
            problems.push_back(problem);
    return scored(problems, request.name.value_or(method.title),
                  score::settings_by(method, request.tune->options, control), control);
}

std::variant<ScoreAnswer, Problem> of_settings(const ScoreRequest& request, const RunControl& control) {
    std::map<std::string, IdealPid> given;
    for (std::size_t i = 0; i < request.settings.size(); ++i) {
        const SubmittedSettings& one = request.settings[i];
        const std::string where = "settings/" + std::to_string(i) + "/problem";
        if (std::ranges::find(problem_library(), one.problem, &score::Problem::name) == problem_library().end())
            return to_problem(Error{ErrorKind::invalid_argument, where,
                                    "The library has no problem \"" + one.problem + "\". See docs/problems.md."});
        if (!given.emplace(one.problem, IdealPid{.Kp = one.Kp, .Ti = one.Ti, .Td = one.Td}).second)
            return to_problem(Error{ErrorKind::invalid_argument, where,
                                    "The problem " + one.problem + " has settings already; give one of them."});
    }
    std::vector<score::Problem> problems;
    for (const score::Problem& problem : problem_library())
        if (request.problems.admits(problem) && given.contains(problem.name)) problems.push_back(problem);
    return scored(
        problems, request.name.value_or("settings"),
        [&given](const score::Problem& problem) { return given.at(problem.name); }, control);
}

/// A number if the text is one; else the text, which the contract then refuses.
Json number_or_text(std::string_view text) {
    double value = 0;
    return read_cell_number(text, value) ? Json(value) : Json(text);
}

Json settings_of(std::string_view csv) {
    Json settings = Json::array();
    std::vector<std::string_view> names, cells;
    std::deque<std::string> storage;
    while (!csv.empty()) {
        const std::size_t end = std::min(csv.find('\n'), csv.size());
        const std::string_view line = trimmed(csv.substr(0, end));
        csv.remove_prefix(std::min(end + 1, csv.size()));
        if (line.empty()) continue;
        auto& into = names.empty() ? names : cells;
        split_line(line, ',', into, storage);
        if (cells.empty()) continue;
        Json one = Json::object();
        for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i)
            if (!cells[i].empty())
                one[std::string(names[i])] = names[i] == "problem" ? Json(cells[i]) : number_or_text(cells[i]);
        settings.push_back(std::move(one));
    }
    return settings;
}

}  // namespace

std::string score_request(const ScoreWords& words, const std::optional<std::string>& file) {
    if (file && trimmed(*file).starts_with('{')) return *file;
    Json request = Json::object();
    const auto set = [](Json& to, const char* name, const std::string& word) {
        if (!word.empty()) to[name] = word;
    };
    set(request, "name", words.name);
    Json problems = Json::object();
    set(problems, "name", words.problems);
    set(problems, "structure", words.structure);
    if (!words.Ms.empty()) problems["Ms"] = number_or_text(words.Ms);
    if (!problems.empty()) request["problems"] = std::move(problems);
    if (file) {
        request["settings"] = settings_of(*file);
        return request.dump();
    }
    Json tune{{"method", words.method.empty() ? "formula" : words.method}};
    set(tune, "Kp", words.Kp);
    set(tune, "Ti", words.Ti);
    set(tune, "Td", words.Td);
    request["tune"] = std::move(tune);
    return request.dump();
}

Answer score_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, score_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<ScoreRequest>(decoded);
    const auto answer = request.tune ? of_rule(request, control) : of_settings(request, control);
    if (const auto* problem = std::get_if<Problem>(&answer)) return refusal(*problem);
    Writer out;
    score_answer_contract().write(std::get<ScoreAnswer>(answer), out);
    return {200, out.take()};
}

}  // namespace tunewright::api
