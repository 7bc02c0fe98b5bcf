#include "server/http/app/problems.h"
#include "server/json_text.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::Response;

Response ready(const JobService& jobs, const JobStore& store, Gate& gate, const Memory& memory) {
    if (jobs.draining()) return http::problem_response(503, "The service is being stopped.");
    if (!store.healthy())
        return http::problem_response(503, "The last write to the store failed, or the store does not answer.");
    if (!gate.ready())
        return http::problem_response(
            503, "The file of keys cannot be used, so nobody is admitted; the log has the reason.");
    if (memory.tight())
        return http::problem_response(503,
                                      "Eight tenths of the memory that the process may use (--memory) are in use.");
    return http::json_response(R"({"status":"ready"})");
}

}  // namespace

void add_liveness_route(http::Router& router, std::size_t max_body, double retention_s) {
    const std::string alive = std::move(JsonObject()
                                            .text("status", "ok")
                                            .text("version", TUNEWRIGHT_VERSION)
                                            .number("max_body_bytes", static_cast<std::int64_t>(max_body))
                                            .number("retention_s", static_cast<std::int64_t>(retention_s)))
                                  .str();
    router.quick("GET", "/healthz", [alive](const Call&) { return http::json_response(alive); });
}

void add_health_routes(http::Router& router, std::size_t max_body, double retention_s, const JobService& jobs,
                       const JobStore& store, Gate& gate, const Memory& memory, std::function<std::string()> metrics) {
    add_liveness_route(router, max_body, retention_s);
    router.quick("GET", "/readyz", [&](const Call&) { return ready(jobs, store, gate, memory); });
    router.add("GET", "/metrics", [metrics = std::move(metrics)](const Call&) {
        Response response;
        response.body = metrics();
        return response.set("Content-Type", "text/plain; version=0.0.4; charset=utf-8");
    });
}

}  // namespace tunewright::server
