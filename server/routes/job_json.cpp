#include "server/routes/job_json.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>

#include "api/json/json.h"
#include "api/service.h"
#include "server/json_text.h"

namespace tunewright::server {
namespace {

std::string moment(const std::optional<UnixMs>& time) { return time ? json_string(iso_time(*time)) : "null"; }

std::string links(const JobSummary& job) {
    const std::string self = "/v1/jobs/" + job.id;
    JsonObject object;
    object.text("self", self);
    if (!has_ended(job.status)) object.text("cancel", self + "/cancel");
    if (transition(job.status, JobEvent::requeue) && !job.settled) object.text("requeue", self + "/requeue");
    if (!job.batch.empty()) object.text("batch", "/v1/batches/" + job.batch);
    return std::move(object).str();
}

/// Only a stopped search leaves a result although it has not succeeded.
bool is_partial(const JobRecord& job) { return !job.result.empty() && job.status != JobStatus::succeeded; }

JsonObject head_of(const JobSummary& job) {
    JsonObject object;
    object.text("id", job.id);
    job.name.empty() ? object.null("name") : object.text("name", job.name);
    object.text("status", to_string(job.status));
    if (!job.batch.empty()) object.text("batch", job.batch).number("index", job.index);
    return object;
}

void add_times(JsonObject& object, const JobSummary& job) {
    object.raw("created_at", moment(job.created_at))
        .raw("started_at", moment(job.started_at))
        .raw("finished_at", moment(job.finished_at))
        .number("attempts", job.attempts);
    if (job.not_before) object.text("not_before", iso_time(*job.not_before));
    if (!job.outline.empty()) object.raw("outline", job.outline);
}

std::string percent_encode(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
                           c == '_' || c == '.' || c == '~';
        if (plain) {
            out.push_back(c);
        } else {
            fmt::format_to(std::back_inserter(out), "%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return out;
}

const char* status_of(const BatchSummary& batch) {
    if (!batch.sealed) return "receiving";
    if (batch.ended()) return "ended";
    return batch.running > 0 || batch.queued < batch.total ? "running" : "queued";
}

std::string counts_of(const BatchSummary& batch) {
    const auto number = [](std::size_t count) { return static_cast<std::int64_t>(count); };
    JsonObject counts;
    counts.number("queued", number(batch.queued))
        .number("running", number(batch.running))
        .number("succeeded", number(batch.succeeded))
        .number("failed", number(batch.failed))
        .number("cancelled", number(batch.cancelled));
    return std::move(counts).str();
}

std::string progress_of(const BatchSummary& batch) {
    const std::size_t ended = batch.succeeded + batch.failed + batch.cancelled;
    const double fraction = batch.total == 0 ? 0 : static_cast<double>(ended) / static_cast<double>(batch.total);
    return std::move(JsonObject().raw("fraction", fmt::format("{:.6g}", fraction))).str();
}

std::string links_of(const BatchSummary& batch) {
    const std::string self = "/v1/batches/" + batch.id;
    JsonObject links;
    links.text("self", self).text("results", self + "/results").text("jobs", "/v1/jobs?batch=" + batch.id);
    if (!batch.ended()) links.text("cancel", self + "/cancel");
    return std::move(links).str();
}

}  // namespace

std::string job_progress_json(const JobView& view) {
    if (view.progress) return api::progress_json(*view.progress);
    if (has_ended(view.job.status)) return "null";
    if (!view.job.progress.empty()) return view.job.progress;
    Progress progress;
    progress.stage = std::string(to_string(view.job.status));
    progress.message = view.job.status == JobStatus::queued ? "Waits for a worker." : "Has just been started.";
    if (view.job.status == JobStatus::queued && view.job.not_before.value_or(0) > wall_clock())
        progress.message = "Waits for its time.";
    return api::progress_json(progress);
}

std::string job_json(const JobView& view) {
    const JobRecord& job = view.job;
    JsonObject object = head_of(job);
    object.raw("progress", job_progress_json(view));
    add_times(object, job);
    object.raw("request", job.request);
    if (!job.result.empty()) object.raw("result", job.result);
    if (!job.error.empty()) object.raw("error", job.error);
    if (is_partial(job)) object.boolean("partial", true);
    object.raw("links", links(job));
    return std::move(object).str();
}

std::string job_news_json(const JobView& view) {
    const JobRecord& job = view.job;
    JsonObject object = head_of(job);
    object.raw("progress", job_progress_json(view));
    add_times(object, job);
    if (!job.error.empty()) object.raw("error", job.error);
    if (is_partial(job)) object.boolean("partial", true);
    object.raw("links", links(job));
    return std::move(object).str();
}

JobRecord without_traces(JobRecord job) {
    job.request = api::without_members(job.request, {"record"});
    job.result = api::without_members(job.result, {"responses", "frequency", "fit", "y_model"});
    job.error = api::without_members(job.error, {"record"});
    return job;
}

std::string notification_job_json(JobRecord job) { return job_json({without_traces(std::move(job)), std::nullopt}); }

std::string job_page_json(const JobPage& page, const JobQuery& query, bool with_owners) {
    std::string list = "[";
    for (const JobSummary& job : page.jobs) {
        JsonObject object = head_of(job);
        if (with_owners && !job.owner.empty()) object.text("owner", job.owner);
        add_times(object, job);
        object.raw("links", links(job));
        if (list.size() > 1) list.push_back(',');
        list.append(std::move(object).str());
    }
    list.push_back(']');

    JsonObject object;
    object.raw("jobs", list);
    if (!page.more) return std::move(object.null("next")).str();
    std::string next = "/v1/jobs?limit=" + std::to_string(query.limit);
    if (query.status) next.append("&status=").append(to_string(*query.status));
    if (query.name) next.append("&name=").append(percent_encode(*query.name));
    if (query.text) next.append("&q=").append(percent_encode(*query.text));
    if (with_owners && query.owner) next.append("&owner=").append(percent_encode(*query.owner));
    if (query.batch) next.append("&batch=").append(percent_encode(*query.batch));
    next.append("&cursor=").append(std::to_string(page.jobs.back().seq));
    return std::move(object.text("next", next)).str();
}

std::optional<std::int64_t> parse_cursor(const std::string& cursor) {
    std::int64_t seq = 0;
    const auto [end, error] = std::from_chars(cursor.data(), cursor.data() + cursor.size(), seq);
    if (error != std::errc{} || end != cursor.data() + cursor.size() || seq < 1) return std::nullopt;
    return seq;
}

std::string batch_json(const BatchSummary& batch, const std::vector<std::string>& notes) {
    std::string list;
    for (const std::string& note : notes) list.append(list.empty() ? "[" : ",").append(json_string(note));
    JsonObject object;
    object.text("id", batch.id);
    batch.name.empty() ? object.null("name") : object.text("name", batch.name);
    object.text("status", status_of(batch))
        .number("total", static_cast<std::int64_t>(batch.total))
        .raw("counts", counts_of(batch))
        .raw("progress", progress_of(batch))
        .boolean("cancel_requested", batch.cancel_requested)
        .text("created_at", iso_time(batch.created_at));
    batch.finished_at ? object.text("finished_at", iso_time(*batch.finished_at)) : object.null("finished_at");
    if (!list.empty()) object.raw("notes", list + "]");
    return std::move(object.raw("links", links_of(batch))).str();
}

std::string batch_page_json(const BatchPage& page, int limit) {
    std::string list = "[";
    for (const BatchSummary& batch : page.batches) {
        if (list.size() > 1) list.push_back(',');
        list.append(batch_json(batch));
    }
    list.push_back(']');
    JsonObject object;
    object.raw("batches", list);
    if (!page.more) return std::move(object.null("next")).str();
    return std::move(object.text("next", "/v1/batches?limit=" + std::to_string(limit) +
                                             "&cursor=" + std::to_string(page.batches.back().seq)))
        .str();
}

}  // namespace tunewright::server
