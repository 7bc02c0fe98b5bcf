#include "api/check_service.h"

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

namespace tunewright::api {
namespace {

/// Loops that could be read, and the others with their place.
struct ReadLoops {
    CheckQuestion question;
    std::vector<std::size_t> places;
    std::vector<std::pair<std::size_t, CheckedLoop>> unreadable;
};

ReadLoops read_loops(CheckRequest&& request) {
    ReadLoops out;
    out.question.cluster = request.cluster;
    out.question.settings = request.settings;
    const Units units = request.units.value_or(Units{});
    for (std::size_t i = 0; i < request.loops.size(); ++i) {
        std::string tag = tag_of(request.loops[i], i);
        auto question = question_of(std::move(request.loops[i]), units, i);
        if (question) {
            out.question.loops.push_back(std::move(*question.value));
            out.places.push_back(i);
        } else {
            out.unreadable.emplace_back(i, CheckedLoop{check::unreadable_loop(std::move(tag), question.why), {}});
        }
    }
    return out;
}

/// The modes as the record of a loop has them: an unknown word counts as manual, and rows before the first mode have
/// that one. Empty if no word is known.
std::vector<bool> automatic_rows(const TaggedLoop& loop) {
    std::vector<std::optional<bool>> meanings;
    for (const std::string& word : loop.mode_words) meanings.push_back(mode_word(word));
    if (std::ranges::none_of(meanings, [](const auto& meaning) { return meaning.has_value(); })) return {};
    std::vector<bool> out;
    out.reserve(loop.mode.size());
    const auto first = std::ranges::find_if(loop.mode, [](std::uint8_t mode) { return mode != 0; });
    for (auto mode = loop.mode.begin(); mode != loop.mode.end(); ++mode)
        out.push_back(meanings[mode < first && first != loop.mode.end() ? *first : *mode].value_or(false));
    return out;
}

check::LoopQuestion question_about(TaggedLoop loop, const std::string& time_unit) {
    const double seconds = seconds_per(time_unit).value_or(1);
    check::LoopQuestion question;
    question.kind = kind_of_tag(loop.tag).kind;
    question.tag = std::move(loop.tag);
    question.seconds = seconds;
    question.units.time = time_unit;
    question.record.automatic = automatic_rows(loop);
    if (loop.epoch) {
        const double zero = loop.t.front();
        question.start = *loop.epoch + zero * seconds;
        for (double& t : loop.t) t -= zero;
    }
    question.record.t = std::move(loop.t);
    question.record.y = std::move(loop.y);
    question.record.u = std::move(loop.u);
    if (hold_reference(loop.r)) question.record.r = std::move(loop.r);
    return question;
}

ReadLoops read_recorded(RecordedLoops& recorded) {
    ReadLoops out;
    out.question.settings = recorded.settings;
    const std::string time_unit = recorded.time_unit.value_or("s");
    for (std::size_t i = 0; i < recorded.loops.size(); ++i) {
        TaggedLoop loop = std::exchange(recorded.loops[i], {});
        if (loop.fault) {
            out.unreadable.emplace_back(i, CheckedLoop{check::unreadable_loop(loop.tag, *loop.fault), {}});
            continue;
        }
        out.question.loops.push_back(question_about(std::move(loop), time_unit));
        out.places.push_back(i);
    }
    return out;
}

/// The engine's answer, with the loops that could not be read in their places.
Expected<CheckResult> checked(ReadLoops loops, const RunControl& control) {
    auto result = ask_check(loops.question, control);
    if (!result || loops.unreadable.empty()) return result;
    for (auto& [place, loop] : loops.unreadable)
        result->loops.insert(result->loops.begin() + static_cast<std::ptrdiff_t>(place), std::move(loop));
    result->plant = judged_together(result->loops, loops.question.cluster);
    return result;
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

JobOutcome outcome_of(Expected<CheckResult> result, const std::optional<Units>& units, std::string_view hash) {
    JobOutcome outcome;
    outcome.method = "check";
    if (!result) {
        outcome.status = JobOutcome::Status::cancelled;
        if (result.error().kind == ErrorKind::cancelled) return outcome;
        outcome.status = JobOutcome::Status::failed;
        outcome.error_json = to_json(to_problem(result.error()));
        return outcome;
    }
    outcome.status = result->partial ? JobOutcome::Status::cancelled : JobOutcome::Status::succeeded;
    outcome.outline_json = outline_of(*result, units);
    Writer out;
    check_result_contract().write({std::move(*result), units, std::string(hash)}, out);
    outcome.result_json = out.take();
    return outcome;
}

}  // namespace

JobOutcome check_outcome(CheckRequest request, std::string_view hash, const RunControl& control) {
    const std::optional<Units> units = request.units;
    return outcome_of(checked(read_loops(std::move(request)), control), units, hash);
}

JobOutcome check_recorded(RecordedLoops recorded, const RunControl& control) {
    std::optional<Units> units;
    if (recorded.time_unit) units.emplace().time = recorded.time_unit;
    std::vector<std::vector<std::string>> notes;
    for (TaggedLoop& loop : recorded.loops) notes.push_back(std::move(loop.notes));
    auto result = checked(read_recorded(recorded), control);
    for (std::size_t i = 0; result && i < notes.size(); ++i)
        for (std::string& note : notes[i])
            result->loops[i].quality.remarks.push_back({"file-read", std::move(note), WarningLevel::warning});
    return outcome_of(std::move(result), units, "");
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
        if (!joined)
            joined = *request;
        else
            for (const Json& loop : (*request)["loops"]) (*joined)["loops"].push_back(loop);
    }
    if (!joined) return std::get<Problem>(std::move(whole));
    return joined->dump();
}

Answer check_call(std::string_view body, const RunControl& control) {
    auto decoded = read_body(body, check_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    auto result = checked(read_loops(std::get<CheckRequest>(std::move(decoded))), control);
    if (!result) return refusal(to_problem(result.error()));
    // The partial result of a check that was stopped is not kept.
    if (result->partial) return refusal(to_problem(Error{ErrorKind::timeout, "", "The check was stopped."}));
    Writer out;
    check_answer_contract().write(*result, out);
    return {200, out.take()};
}

}  // namespace tunewright::api
