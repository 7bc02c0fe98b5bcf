#include "server/startup_server.h"

#include <chrono>
#include <future>
#include <thread>

#include "server/http/app/problems.h"
#include "server/http/app/router.h"
#include "server/log.h"
#include "server/routes/routes.h"
#include "server/store/open_store.h"

namespace tunewright::server {
namespace {

constexpr std::chrono::milliseconds kQuietOpenTime{700};       // most stores open sooner; a longer wait is logged
constexpr std::chrono::seconds kRetryInterval{2};              // if another process migrates the store
constexpr std::chrono::milliseconds kSignalPollInterval{100};  // between checks whether the process is to end
constexpr const char* kNotYet =
    "The store is not open yet: its tables are being migrated, or its disk is full; the log has the reason. Try again "
    "later.";

/// A server that reports the state of the startup.
class StartupServer {
public:
    StartupServer(const std::string& listen, const Config& config) : server_(http::ServerLimits(), application()) {
        add_liveness_route(router_, config.max_body, config.retention_s);
        open_port(server_, listen);
        serving_ = std::jthread([this] { server_.run(); });
    }
    ~StartupServer() {
        server_.stop();
        serving_.join();
        server_.idle_within(std::chrono::seconds(2));
    }

private:
    http::Application application() {
        http::Application made;
        made.handle = [this](http::Request request) {
            if (request.path() == "/healthz") return router_.handle(std::move(request));
            http::Response response = http::problem_response(503, kNotYet);
            http::add_common_headers(response);
            return response;
        };
        made.refuse = [](int status, const std::string& detail, http::Request&) {
            return http::problem_response(status, detail);
        };
        return made;
    }

    http::Router router_;
    http::Server server_;
    std::jthread serving_;
};

/// Opens the store; waits for one that another process must migrate.
std::unique_ptr<JobStore> open_patiently(const Config& config, const std::stop_token& stop) {
    const SchemaSteps steps = config.migrate == "manual" ? SchemaSteps::leave : SchemaSteps::take;
    for (bool logged = false; !stop.stop_requested();) {
        try {
            return open_store(config.store, steps, config.pooled);
        } catch (const SchemaBehind& behind) {
            if (!std::exchange(logged, true)) log_info(std::string("waiting: ") + behind.what());
        } catch (const StoreError& error) {
            if (error.kind != StoreFault::Kind::full) throw;
            if (!std::exchange(logged, true)) log_error(std::string("waiting for room: ") + error.what());
        }
        for (auto waited = kSignalPollInterval; waited < kRetryInterval && !stop.stop_requested();
             waited += kSignalPollInterval)
            std::this_thread::sleep_for(kSignalPollInterval);
    }
    return nullptr;
}

}  // namespace

int open_port(http::Server& server, const std::string& listen) {
    const HostPort address = parse_listen(listen);
    return server.listen(address.host, address.port);
}

std::unique_ptr<JobStore> open_behind_startup_server(const Config& config, const sigset_t& signals) {
    std::promise<std::unique_ptr<JobStore>> opened;
    std::future<std::unique_ptr<JobStore>> store = opened.get_future();
    std::jthread opening([&](const std::stop_token& stop) {
        try {
            opened.set_value(open_patiently(config, stop));
        } catch (...) {
            opened.set_exception(std::current_exception());
        }
    });
    if (store.wait_for(kQuietOpenTime) == std::future_status::ready) return store.get();
    const StartupServer desk(config.listen, config);
    const auto probes =
        config.metrics_listen.empty() ? nullptr : std::make_unique<StartupServer>(config.metrics_listen, config);
    const timespec look{0, std::chrono::nanoseconds(kSignalPollInterval).count()};
    while (store.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        if (sigtimedwait(&signals, nullptr, &look) > 0) {
            log_info("stopped before the store was open");
            opening.request_stop();
            // A step in progress is rolled back by the end of the process.
            if (store.wait_for(std::chrono::seconds(1)) != std::future_status::ready) ::_exit(0);
            return nullptr;
        }
    return store.get();
}

}  // namespace tunewright::server
