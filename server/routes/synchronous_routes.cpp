#include <chrono>
#include <functional>

#include "api/certificate/certificate_call.h"
#include "api/registries.h"
#include "api/service.h"
#include "api/services/check_service.h"
#include "api/services/range_service.h"
#include "api/services/score_service.h"
#include "api/services/structure_service.h"
#include "api/services/verify/verify_call.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/routes/computations.h"
#include "server/routes/job_access.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;
using SyncCall = std::function<api::Answer(const Call&, const RunControl&)>;

using Refusal = std::optional<Response> (*)(const http::Request&);

constexpr std::chrono::seconds kEvaluateTime{10};
constexpr std::chrono::seconds kDesignTime{10};
constexpr std::chrono::seconds kRangeTime{20};
constexpr std::chrono::seconds kStructureTime{20};
constexpr std::chrono::seconds kIdentifyTime{30};
constexpr std::chrono::seconds kCheckTime{30};
constexpr std::chrono::seconds kScoreTime{60};
constexpr std::chrono::seconds kVerifyTime{60};
constexpr std::chrono::seconds kRelayTime{10};
constexpr std::chrono::seconds kConversionTime{10};
constexpr std::chrono::seconds kCertificateTime{120};

bool is_file(const http::Request& request) {
    const std::string type = http::media_type(request);
    return type == "text/csv" || type == "application/csv" || type == "text/tab-separated-values" ||
           type == "text/plain" || type == "application/octet-stream";
}

/// The body is a file of a recorded test, or JSON that contains it.
std::optional<Response> refuse_file_call(const http::Request& request) {
    if (!is_file(request) && !http::sends_json(request))
        return problem_response(415, "The body must be the file itself, with Content-Type: text/csv, or JSON.");
    return refuse_form(request);
}

api::Answer preview(const Call& call, const RunControl&) {
    return is_file(call.request) ? api::preview_file(call.request.body) : api::preview_call(call.request.body);
}

/// The time limit counts from the arrival of the request, including the wait for its turn.
http::Handler synchronous(const SyncCall& work, std::chrono::seconds limit, const Computations& computations,
                          Refusal refuse) {
    return [=](const Call& call) {
        if (auto refusal = refuse(call.request)) return *std::move(refusal);
        return computations.answer(call.request, limit, [&](const RunControl& control) { return work(call, control); });
    };
}

/// A call whose only input is its body.
SyncCall of_body(api::Answer (*work)(std::string_view, const RunControl&)) {
    return [work](const Call& call, const RunControl& control) { return work(call.request.body, control); };
}

/// A conversion for the product in the path.
SyncCall of_product(api::Answer (*work)(std::string_view, std::string_view)) {
    return [work](const Call& call, const RunControl&) { return work(call.path.at("id"), call.request.body); };
}

/// The certificate's file of a job whose result holds a certificate.
api::Answer certificate_of(JobService& jobs, const Call& call, const RunControl& control) {
    const auto view = jobs.find(call.path.at("id"));
    if (!view || !may_see(call.request, view->job)) return api::refusal(http::problem(404, "There is no such job."));
    const JobRecord& job = view->job;
    if (job.result.empty()) return api::refusal(http::problem(409, "The job " + job.id + " has no result yet."));
    const auto file = api::certificate_file({job.result, job.request}, call.path.at("index"), control);
    if (const auto* problem = std::get_if<api::Problem>(&file)) return api::refusal(*problem);
    return {200, std::get<std::string>(file)};
}

std::optional<Response> no_body(const http::Request&) { return std::nullopt; }

/// The answer of `handler` as a file to keep.
http::Handler as_file(http::Handler handler, const std::string& media_type, const std::string& name) {
    return [=](Call& call) {
        Response response = handler(call);
        if (response.status != 200) return response;
        response.set("Content-Type", media_type);
        return response.set("Content-Disposition", "attachment; filename=\"" + name + "\"");
    };
}

/// Answered at once: while a user types, it is called at each key, and does not wait for computations.
Response parse_plant(const Call& call) {
    if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
    return response_of(api::parse_plant_call(call.request.body));
}

}  // namespace

void add_synchronous_routes(http::Router& router, JobService& jobs, const Computations& computations) {
    const auto add = [&](const char* path, const SyncCall& work, std::chrono::seconds limit,
                         Refusal refuse = refuse_call) {
        router.add("POST", path, synchronous(work, limit, computations, refuse));
    };
    const auto certificate = [&jobs](const Call& call, const RunControl& control) {
        return certificate_of(jobs, call, control);
    };
    router.add("GET", "/v1/jobs/{id}/controllers/{index}/certificate",
               as_file(synchronous(certificate, kCertificateTime, computations, no_body), api::kCertificateMediaType,
                       "certificate.jsonl"));
    router.add("POST", "/v1/plants/parse", parse_plant);
    add("/v1/evaluate", of_body(api::evaluate_call), kEvaluateTime);
    add("/v1/design", of_body(api::design_call), kDesignTime);
    add("/v1/frontier", of_body(api::frontier_call), kDesignTime);
    add("/v1/range", of_body(api::range_call), kRangeTime);
    add("/v1/cascade", of_body(api::cascade_call), kStructureTime);
    add("/v1/level", of_body(api::level_call), kStructureTime);
    add("/v1/feedforward", of_body(api::feedforward_call), kStructureTime);
    add("/v1/interaction", of_body(api::interaction_call), kStructureTime);
    add("/v1/predictor", of_body(api::predictor_call), kStructureTime);
    add("/v1/score", of_body(api::score_call), kScoreTime);
    add("/v1/verify", of_body(api::verify_call), kVerifyTime);
    add("/v1/check", of_body(api::check_call), kCheckTime);
    add("/v1/identify", of_body(api::identify_call), kIdentifyTime);
    add("/v1/records/controller", of_body(api::controller_record_call), kIdentifyTime);
    add("/v1/records/preview", preview, kIdentifyTime, refuse_file_call);
    add("/v1/experiments/relay", of_body(api::relay_call), kRelayTime);
    add("/v1/experiments/range", of_body(api::range_experiments_call), kRangeTime);
    add("/v1/controllers/{id}/settings", of_product(api::controller_settings_call), kConversionTime);
    add("/v1/controllers/{id}/schedule", of_product(api::controller_schedule_call), kConversionTime);
    add("/v1/controllers/{id}/controller", of_product(api::controller_twin_call), kConversionTime);
}

}  // namespace tunewright::server
