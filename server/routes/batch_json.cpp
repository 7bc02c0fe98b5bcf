#include "server/routes/batch_json.h"

#include <cstdio>

#include "server/json_text.h"

namespace tunewright::server {
namespace {

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
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", fraction);
    return std::move(JsonObject().raw("fraction", text)).str();
}

std::string links_of(const BatchSummary& batch) {
    const std::string self = "/v1/batches/" + batch.id;
    JsonObject links;
    links.text("self", self).text("results", self + "/results").text("jobs", "/v1/jobs?batch=" + batch.id);
    if (!batch.ended()) links.text("cancel", self + "/cancel");
    return std::move(links).str();
}

}  // namespace

std::string batch_json(const BatchSummary& batch) {
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
