#include "server/routes/batch_checks.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "server/http/app/problems.h"
#include "server/routes/job_access.h"
#include "server/routes/request_checks.h"

namespace tunewright::server {
namespace {

constexpr std::int64_t kMaxCheckedLoops = 5000;  // read into memory for their common judgement
constexpr std::size_t kRowsAtOnce = 100;

void add_ended(Batches& batches, const std::string& id, api::PlantChecks& checks) {
    for (std::int64_t next = 0;;) {
        const std::vector<BatchRow> rows = batches.rows(id, next, kRowsAtOnce);
        if (rows.empty()) return;
        for (const BatchRow& row : rows) {
            if (has_ended(row.status)) checks.add({row.index, row.id, row.name, row.result, row.error});
            next = row.index + 1;
        }
    }
}

}  // namespace

std::variant<BatchOfChecks, http::Response> read_checks(Batches& batches, const http::Request& request,
                                                        const std::string& id, api::PlantChecks::Kept kept) {
    std::optional<BatchSummary> batch = batches.find(id);
    if (!batch || !may_see(request, *batch)) return no_such_batch(id);
    if (static_cast<std::int64_t>(batch->total) > kMaxCheckedLoops)
        return http::problem_response(
            422, "The batch has " + std::to_string(batch->total) + " entries; loops are judged together up to " +
                     std::to_string(kMaxCheckedLoops) + ". Check a part of the plant at a time.");
    BatchOfChecks out{*std::move(batch), api::PlantChecks(kept)};
    add_ended(batches, id, out.checks);
    if (out.checks.loops() == 0 && out.batch.ended())
        return http::problem_response(
            409, "The batch has no checked loop. It must be one of kind=check, or of check requests.");
    return out;
}

}  // namespace tunewright::server
