#include "api/services/verify/verify_call.h"

#include <optional>
#include <string>
#include <utility>

#include "api/contract/range/range_request.h"
#include "api/contract/request.h"
#include "api/contract/structure/structure_name.h"
#include "api/describe/body.h"
#include "api/services/verify/verify_entry.h"
#include "engine/evaluation/evaluate.h"

namespace tunewright::api {
namespace {

Problem no_request() {
    Problem problem{422, "invalid-request", "The request is not valid", {}, {}, {}};
    problem.detail =
        "The request that led to the result is missing: it has the plant. Give a whole job, the output of tune "
        "--with-request, or the file of the request.";
    return problem;
}

Problem stopped() { return to_problem(Error{ErrorKind::timeout, "", "The verification was not finished."}); }

/// The request of a tuning job, a design or an evaluation.
std::variant<JobRequest, Problem> read_request(const Json& request) {
    if (!request.contains("start") && !request.contains("model")) return decode(request, job_contract());
    auto design = decode(request, design_request_contract());
    if (auto* problem = std::get_if<Problem>(&design)) return std::move(*problem);
    return JobRequest(std::move(std::get<DesignRequest>(design)));
}

/// The plant that a record gave, from the result.
std::optional<LinearPlant> identified_plant(const JobRequest& request, const Json& result) {
    if (request.model) {
        auto made = LinearPlant::make(request.model->plant);
        return made ? std::optional(std::move(*made)) : std::nullopt;
    }
    const Json::json_pointer place("/model/plant");
    if (!result.contains(place)) return std::nullopt;
    return decode_plant(result.at(place));
}

std::optional<Problem> verify_controllers(VerifyAnswer& answer, const Json& request, const Json& result,
                                          const RunControl& control) {
    auto decoded = read_request(request);
    if (auto* problem = std::get_if<Problem>(&decoded)) return std::move(*problem);
    const JobRequest& asked = std::get<JobRequest>(decoded);
    const std::optional<LinearPlant> identified = asked.subject ? std::nullopt : identified_plant(asked, result);
    VerifiedSubject subject{.options = asked.evaluate};
    if (asked.subject) {
        subject.plant = asked.subject->linear();
        subject.nonlinear = asked.subject->equations() != nullptr;
        subject.options = on_linearisation(*asked.subject, subject.options);
    } else if (identified) {
        subject.plant = &*identified;
    }
    const Json& entries = result.at("controllers");
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (control.stop.stop_requested()) return stopped();
        verify_entry(answer, "/controllers/" + std::to_string(i), entries[i], subject);
    }
    return std::nullopt;
}

}  // namespace

std::variant<VerifyAnswer, Problem> verify_result(const ResultSource& source, const RunControl& control) try {
    ChosenEntry found;
    if (auto problem = read_result(source, found)) return *std::move(problem);
    if (!found.result.is_object()) return not_a_result();
    VerifyAnswer answer;
    const std::string structure = structure_of(found.result);
    if (!structure.empty()) {
        answer.not_verified.push_back({"", "Loops around the loop have no second computation here."});
        return answer;
    }
    if (found.result.contains("range")) {
        verify_range(answer, found.result.at("range"));
        return answer;
    }
    if (!found.result.contains("controllers")) return not_a_result();
    if (!found.request.is_object()) return no_request();
    if (auto problem = verify_controllers(answer, found.request, found.result, control)) return *std::move(problem);
    for (const char* part : {"model", "replay"})
        if (found.result.contains(part))
            answer.not_verified.push_back(
                {std::string("/") + part, "What was found in a record has no second computation here."});
    return answer;
} catch (const Json::exception&) {
    return not_a_result();
}

std::string verify_json(const VerifyAnswer& answer) {
    Writer out;
    verify_answer_contract().write(answer, out);
    return out.take();
}

Answer verify_call(std::string_view body, const RunControl& control) {
    auto verified = verify_result({body}, control);
    if (auto* problem = std::get_if<Problem>(&verified)) {
        // A body that is not a result is a wrong request; no resource is missing.
        if (problem->status == 404) {
            problem->status = 422;
            problem->type = "invalid-request";
            problem->title = "The request is not valid";
        }
        return refusal(*problem);
    }
    return {200, verify_json(std::get<VerifyAnswer>(verified))};
}

}  // namespace tunewright::api
