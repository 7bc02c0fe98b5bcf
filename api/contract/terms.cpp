#include "api/contract/terms.h"

#include <chrono>
#include <cmath>

#include "api/contract/check/check_request.h"
#include "api/contract/range/range_request.h"
#include "api/contract/request.h"
#include "api/contract/structure/cascade_call.h"
#include "api/contract/structure/feedforward_call.h"
#include "api/contract/structure/interaction_call.h"
#include "api/contract/structure/level_call.h"
#include "api/contract/structure/predictor_call.h"
#include "api/csv/time_stamp.h"
#include "api/describe/body.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxUrl = 2000;
constexpr std::size_t kMaxSecretName = 64;
constexpr double kLongestTimeout = 3600;  // s
constexpr int kMaxDaysAhead = 30;         // for which a job may wait for its time

}  // namespace

const Description<Notify>& notify_contract() {
    static const auto description = [] {
        Description<Notify> d(
            "Notify",
            "Webhook for the end of the job or batch: a POST to that address, signed according to Standard Webhooks, "
            "and repeated for a day until the answer has a status from 200 to 299.");
        d.field("url", &Notify::url, text(kMaxUrl), "The address, which the operator of the service must have allowed.",
                {.required = true})
            .field("secret_id", &Notify::secret_id, text(kMaxSecretName),
                   "The name of the operator's secret that signs it. Default: the first.", {.no_default = true})
            .example({{"url", "https://hooks.example.com/tunewright"}, {"secret_id", "line-1"}});
        return d;
    }();
    return description;
}

namespace {

/// The codec of a date and a time of day with its zone, ISO 8601, as milliseconds since 1970, UTC.
Codec<std::int64_t> moment() {
    Codec<std::int64_t> codec;
    codec.read = [](const Json& value, std::int64_t& target, Reader& reader) {
        const auto rule = "a time such as \"2026-05-04T06:00:00Z\"";
        if (!value.is_string()) return reader.fault(wrong_kind(value, rule, reader));
        const auto& text = value.get_ref<const std::string&>();
        // Only dates that begin with the year: the order of others is ambiguous.
        const bool iso = text.size() > 4 && text.find_first_not_of("0123456789") >= 4;
        const auto stamp = iso ? read_time_stamp(text) : std::nullopt;
        if (stamp && stamp->has_date && stamp->has_clock && stamp->has_zone) {
            target = std::llround(stamp->seconds * 1e3);
            return;
        }
        const bool known = stamp && stamp->has_date && stamp->has_clock;
        reader.fault(reader.name() + " is " +
                     Json(text.substr(0, 48)).dump(-1, ' ', false, Json::error_handler_t::replace) +
                     (known ? ", which has no zone; end it with Z for UTC or with an offset such as +02:00."
                            : "; it must be " + std::string(rule) + " (ISO 8601 with a zone)."));
    };
    codec.schema = [](SchemaBook&) { return Json{{"type", "string"}, {"format", "date-time"}}; };
    return codec;
}

}  // namespace

template <class Request>
void add_terms(Description<Request>& description) {
    description
        .field("timeout_s", &JobTerms::timeout_s, number({.exclusive_minimum = 0, .maximum = kLongestTimeout}),
               "Time limit of the job, after which it fails with type timeout.", {.unit = "s"})
        .field("priority", &JobTerms::low_priority, choice<bool>({{"normal", false}, {"low", true}}),
               "low: its turn is among the entries of batches, after single jobs of normal priority.")
        .field("not_before", &JobTerms::not_before, maybe(moment()),
               "The job starts at this time or later; a time in the past means at once. ISO 8601 with a zone, such as "
               "2026-05-04T06:00:00Z; at most " +
                   std::to_string(kMaxDaysAhead) + " days ahead.")
        .field("unique", &JobTerms::unique, boolean(),
               "true: if a stored job with the same request waits, runs or has succeeded, the answer is that job and "
               "no second one is created. Name, timeout_s and every other member count; notify, priority, not_before "
               "and unique do not.")
        .field("notify", &JobTerms::notify, maybe(object(notify_contract())), "Webhook for the end of the job.");
}

template void add_terms(Description<JobRequest>& description);
template void add_terms(Description<RangeRequest>& description);
template void add_terms(Description<CheckRequest>& description);
template void add_terms(Description<CascadeRequest>& description);
template void add_terms(Description<LevelRequest>& description);
template void add_terms(Description<FeedforwardRequest>& description);
template void add_terms(Description<InteractionRequest>& description);
template void add_terms(Description<PredictorRequest>& description);

std::optional<Problem> refuse_far(const std::optional<std::int64_t>& not_before) {
    using std::chrono::milliseconds;
    const auto latest = std::chrono::system_clock::now() + std::chrono::days(kMaxDaysAhead);
    if (!not_before || milliseconds(*not_before) <= latest.time_since_epoch()) return std::nullopt;
    Reader reader;
    reader.fault_at("not_before", "not_before is more than " + std::to_string(kMaxDaysAhead) +
                                      " days ahead, the longest time for which a job may be scheduled. Give an earlier "
                                      "time, or post the job later.");
    return reader.problem();
}

std::variant<Notify, Problem> read_notify(std::string_view json) {
    auto parsed = parse(json);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    Notify notify;
    Reader reader;
    {
        const Reader::At at(reader, "notify");
        notify_contract().read(std::get<Json>(parsed), notify, reader);
    }
    if (auto problem = reader.problem()) return *std::move(problem);
    return notify;
}

void leave_out_terms(Json& request) {
    request.erase("notify");
    request.erase("priority");
    request.erase("not_before");
    request.erase("unique");
}

std::optional<Problem> refuse_terms_of_entry(const Json& request) {
    if (!request.is_object()) return std::nullopt;
    Reader reader;
    if (request.contains("notify"))
        reader.fault_at("notify",
                        "notify is in an entry, but a batch has one notification as a whole: put notify next to jobs, "
                        "or into the parameter notify_url.");
    if (const auto at = request.find("priority"); at != request.end() && *at == "normal")
        reader.fault_at(
            "priority",
            "priority is \"normal\", which is not possible in a batch: leave it out, or post the job alone.");
    for (const char* name : {"not_before", "unique"})
        if (request.contains(name))
            reader.fault_at(name, std::string(name) +
                                      " is in an entry, but only a job that is posted alone can have it: leave it out, "
                                      "or post the job with POST /v1/jobs.");
    return reader.problem();
}

}  // namespace tunewright::api
