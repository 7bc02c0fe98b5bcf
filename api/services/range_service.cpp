#include "api/services/range_service.h"

#include <algorithm>
#include <utility>

#include "api/contract/range/range_experiments.h"
#include "api/contract/range/range_request.h"
#include "api/contract/range/range_result.h"
#include "api/describe/body.h"
#include "api/services/job_outcome.h"

namespace tunewright::api {
namespace {

/// The engine's answer, with the findings of reading the records.
Expected<RangeResult> answered_range(const RangeRequest& request, const RunControl& control) {
    auto result = ask_range(request.question, control);
    if (!result) return result;
    for (std::size_t k = 0; k < result->points.size(); ++k) {
        auto& model = result->points[k].model;
        if (!model) continue;
        add_reading(request.reads.at(k), *model);
        leave_out_traces(request.identify, *model);
    }
    return result;
}

/// The problem with samples of the record to which the error refers, which show what was read.
Problem problem_of(const Error& error, const RangeRequest& request) {
    Problem problem = to_problem(error);
    for (std::size_t k = 0; k < request.question.points.size(); ++k) {
        const auto* record = std::get_if<Record>(&request.question.points[k].content);
        if (record != nullptr && error.where == "points/" + std::to_string(k) + "/record")
            problem.record = samples_of(*record, request.identify.traces ? kPlotRows : kExcerptRows);
    }
    return problem;
}

/// JobOutline of the document. Ms: the largest over the range, with the schedule if there is one, else with one
/// setting.
std::string outline_of(const RangeContent& content, const std::optional<Units>& units) {
    Writer out;
    out.begin_object();
    if (units) {
        out.key("units");
        units_contract().write(*units, out);
    }
    out.key("method").text("range");
    const auto& worst = content.schedule ? content.worst.schedule : content.worst.one;
    const auto largest = std::ranges::find(worst, range::Quantity::Ms, &range::WorstPoint::quantity);
    out.key("Ms");
    largest != worst.end() && largest->value ? out.number(*largest->value) : out.null();
    out.key("range").begin_object();
    out.key("scheduling").text(content.result.scheduling.name);
    out.key("points").integer(static_cast<long long>(content.result.points.size()));
    out.key("rows").integer(content.schedule ? static_cast<long long>(content.schedule->schedule.rows.size()) : 0);
    out.end_object();
    out.end_object();
    return out.take();
}

}  // namespace

JobOutcome range_outcome(RangeRequest request, std::string_view hash, const RunControl& control) {
    auto result = answered_range(request, control);
    if (!result)
        return without_result("range", problem_of(result.error(), request),
                              result.error().kind == ErrorKind::cancelled);
    const bool partial = result->design.partial;
    const RangeAnswer answer{RangeContent(std::move(*result)), request.units, std::string(hash)};
    Writer out;
    range_result_contract().write(answer, out);
    return with_result("range", partial, outline_of(answer.range, answer.units), out.take());
}

Answer range_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, range_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<RangeRequest>(decoded);
    auto result = answered_range(request, control);
    if (!result) return refusal(problem_of(result.error(), request));
    // The partial result of a search that was stopped is not kept.
    if (result->design.partial) return refusal(to_problem(Error{ErrorKind::timeout, "", "The design was stopped."}));
    Writer out;
    range_answer_contract().write({RangeContent(std::move(*result)), {}, {}}, out);
    return {200, out.take()};
}

Answer range_experiments_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, range_experiments_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<RangeExperimentsRequest>(decoded);
    auto tests = test_places(*request.branch, request.experiment, control);
    if (!tests) return refusal(to_problem(tests.error()));
    Writer out;
    range_experiments_answer_contract().write({request.branch, std::move(*tests)}, out);
    return {200, out.take()};
}

}  // namespace tunewright::api
