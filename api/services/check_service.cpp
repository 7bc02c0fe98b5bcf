#include "api/services/check_service.h"

#include <algorithm>
#include <utility>

#include "api/contract/check/check_result.h"
#include "api/contract/check/loop_check.h"
#include "api/csv/cell.h"
#include "api/csv/columns/loop_mode.h"
#include "api/csv/shape/held_values.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"
#include "api/describe/body.h"
#include "api/historian/tags/loop_tags.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "api/services/job_outcome.h"

namespace tunewright::api {
namespace {

CheckQuestion question_of(CheckRequest&& request) {
    CheckQuestion out;
    out.cluster = request.cluster;
    out.settings = request.settings;
    const Units units = request.units.value_or(Units{});
    for (std::size_t i = 0; i < request.loops.size(); ++i)
        out.loops.push_back(question_of(std::move(request.loops[i]), units, i));
    return out;
}

/// Gives the record the modes of the loop, as a record in CSV has them, and notes those that are not known.
void read_modes(const TaggedLoop& loop, check::LoopQuestion& out) {
    if (loop.mode.empty()) return;
    ModeColumn column;
    for (const std::uint8_t mode : loop.mode) {
        column.see(loop.mode_words[mode]);
        column.add_row();
    }
    if (std::string unknown = column.unknown(); !unknown.empty()) out.notes.push_back(std::move(unknown));
    out.record.automatic = column.take();
}

check::LoopQuestion question_about(TaggedLoop loop, const LoopFacts& facts, const std::string& time_unit) {
    check::LoopQuestion question;
    question.seconds = seconds_per(time_unit);
    question.units.time = time_unit;
    question.kind = kind_of_tag(loop.tag).kind;
    question.tag = std::move(loop.tag);
    question.unreadable = std::move(loop.fault);
    if (question.unreadable) return question;
    question.notes = reading_notes(loop);
    read_modes(loop, question);
    add_facts(facts, question);
    if (loop.epoch) {
        const double zero = loop.t.front();
        question.start = *loop.epoch + zero * question.seconds.value_or(1);
        for (double& t : loop.t) t -= zero;
    }
    question.record.t = std::move(loop.t);
    question.record.y = std::move(loop.y);
    question.record.u = std::move(loop.u);
    if (hold_reference(loop.r)) question.record.r = std::move(loop.r);
    return question;
}

CheckQuestion question_of(RecordedLoops& recorded) {
    CheckQuestion out;
    out.settings = recorded.settings;
    for (std::size_t i = 0; i < recorded.loops.size(); ++i)
        out.loops.push_back(question_about(std::exchange(recorded.loops[i], {}),
                                           i < recorded.facts.size() ? recorded.facts[i] : LoopFacts{},
                                           recorded.time_unit.value_or("s")));
    return out;
}

/// JobOutline of the document: of the loop to mend first.
std::string outline_of(const CheckResult& result, const std::optional<Units>& units) {
    const check::LoopCheck& first = result.loops[result.plant.ranking.front().loop];
    Writer out;
    out.begin_object();
    if (units) {
        out.key("units");
        units_contract().write(*units, out);
    }
    out.key("method").text("check");
    out.key("check").begin_object();
    out.key("loops").integer(static_cast<long long>(result.loops.size()));
    out.key("tag").text(first.tag);
    out.key("verdict");
    check_verdict().write(first.cause.verdict, out);
    out.key("action");
    check_action().write(first.action.code, out);
    out.end_object();
    out.end_object();
    return out.take();
}

JobOutcome outcome_of(Expected<CheckResult> result, CheckAnswer rest) {
    if (!result)
        return without_result("check", to_problem(result.error()), result.error().kind == ErrorKind::cancelled);
    const bool partial = result->partial;
    std::string outline = outline_of(*result, rest.units);
    Writer out;
    rest.check = std::move(*result);
    check_result_contract().write(rest, out);
    return with_result("check", partial, std::move(outline), out.take());
}

/// True if every member but the loops is that of the first request, or left to it.
bool belongs_to(const Json& request, const Json& first) {
    for (const auto& [name, value] : request.items())
        if (name != "loops" && (!first.contains(name) || first[name] != value)) return false;
    return true;
}

}  // namespace

JobOutcome check_outcome(CheckRequest request, std::string_view hash, const RunControl& control) {
    CheckAnswer rest{{}, request.units, std::string(hash), {}};
    return outcome_of(ask_check(question_of(std::move(request)), control), std::move(rest));
}

JobOutcome check_recorded(RecordedLoops recorded, const RunControl& control) {
    CheckAnswer rest;
    if (recorded.time_unit) rest.units.emplace().time = recorded.time_unit;
    rest.notes = std::move(recorded.notes);
    if (recorded.loops.empty())
        return outcome_of(Error{ErrorKind::invalid_argument, "",
                                "The files hold no loop: a loop has a measurement and a controller output, such as "
                                "FIC101.PV and FIC101.OP."},
                          std::move(rest));
    return outcome_of(ask_check(question_of(recorded), control), std::move(rest));
}

bool is_check_text(std::string_view request) { return is_check_request(Json::parse(request, nullptr, false)); }

std::variant<std::string, Problem> joined_requests(std::string_view text) {
    auto whole = parse(text);
    if (std::holds_alternative<Json>(whole)) return std::string(text);
    std::optional<Json> joined;
    std::size_t at = 0;
    for (int number = 1; const auto line = next_line(text, at); ++number) {
        if (trimmed(*line).empty()) continue;
        auto parsed = parse(*line);
        const auto* request = std::get_if<Json>(&parsed);
        // The text of one request over several lines: its own fault is the better one.
        if (request == nullptr && !joined) return std::get<Problem>(std::move(whole));
        if (request == nullptr || !is_check_request(*request) || !(*request)["loops"].is_array()) {
            Problem problem{400, "not-json", "The body is not a request for a check", {}, {}, {}};
            problem.detail = "Line " + std::to_string(number) + " is not a request for a check: {\"loops\": [...]}.";
            return problem;
        }
        if (!joined) {
            joined = *request;
            continue;
        }
        if (!belongs_to(*request, *joined)) {
            Problem problem{422, "invalid-request", "The requests do not belong together", {}, {}, {}};
            problem.detail = "Line " + std::to_string(number) +
                             " differs from the first in a member beside loops, such as units or settings. Give the "
                             "same ones in every line, or check them apart.";
            return problem;
        }
        for (const Json& loop : (*request)["loops"]) (*joined)["loops"].push_back(loop);
    }
    if (!joined) return std::get<Problem>(std::move(whole));
    return joined->dump();
}

Answer check_call(std::string_view body, const RunControl& control) {
    auto decoded = read_body(body, check_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    auto result = ask_check(question_of(std::get<CheckRequest>(std::move(decoded))), control);
    if (!result) return refusal(to_problem(result.error()));
    // The partial result of a check that was stopped is not kept.
    if (result->partial) return refusal(to_problem(Error{ErrorKind::timeout, "", "The check was stopped."}));
    Writer out;
    check_answer_contract().write(*result, out);
    return {200, out.take()};
}

}  // namespace tunewright::api
