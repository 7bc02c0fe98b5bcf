#include "api/check_service.h"

#include <utility>

#include "api/contract/check/check_result.h"
#include "api/contract/check/loop_check.h"
#include "api/describe/body.h"
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

/// The engine's answer, with the loops that could not be read in their places.
Expected<CheckResult> checked(CheckRequest request, const RunControl& control) {
    ReadLoops loops = read_loops(std::move(request));
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

}  // namespace

JobOutcome check_outcome(CheckRequest request, std::string_view hash, const RunControl& control) {
    JobOutcome outcome;
    outcome.method = "check";
    const std::optional<Units> units = request.units;
    auto result = checked(std::move(request), control);
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

Answer check_call(std::string_view body, const RunControl& control) {
    auto decoded = read_body(body, check_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    auto result = checked(std::get<CheckRequest>(std::move(decoded)), control);
    if (!result) return refusal(to_problem(result.error()));
    // What a stopped check has found is not kept.
    if (result->partial) return refusal(to_problem(Error{ErrorKind::timeout, "", "The check was stopped."}));
    Writer out;
    check_answer_contract().write(*result, out);
    return {200, out.take()};
}

}  // namespace tunewright::api
