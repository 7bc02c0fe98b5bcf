// `tunewright serve` with its options.
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "server/cli/command_tree.h"
#include "server/config.h"
#include "server/serve.h"

namespace tunewright::server {
namespace {

void flag(CLI::App& app, const std::string& name, bool& value, const std::string& help) {
    app.add_flag("--" + name, value, help)->envname(variable_of(name));
}

/// Adds an option that is typed with a unit and stored as a number; `shown` is the default as typed.
template <class T>
void quantity(CLI::App& app, const std::string& name, T& value, T (*read)(const std::string&), const std::string& shown,
              std::pair<double, double> range, const std::string& help) {
    const auto take = [&value, read, range, name](const std::string& text) {
        try {
            value = read(text);
        } catch (const std::invalid_argument& error) {
            throw CLI::ValidationError("--" + name, error.what());
        }
        if (static_cast<double>(value) < range.first || static_cast<double>(value) > range.second)
            throw CLI::ValidationError("--" + name, "\"" + text + "\" is out of range");
    };
    app.add_option_function<std::string>("--" + name, take, help)->envname(variable_of(name))->default_str(shown);
}

/// CLI::Range accepts NaN, which is neither below nor above a bound.
CLI::Validator number_within(double min, double max) {
    const auto judge = [min, max](const std::string& text) -> std::string {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error == std::errc{} && end == text.data() + text.size() && value >= min && value <= max) return {};
        return fmt::format("\"{}\" must be a number from {:g} to {:g}", text, min, max);
    };
    return {judge, fmt::format("{:g} to {:g}", min, max)};
}

/// `unset`: what is shown for a default that is not a time.
void duration(CLI::App& app, const std::string& name, double& seconds, std::pair<double, double> range,
              const std::string& help, const std::string& unset = "") {
    constexpr double day = 86400;
    const bool days = seconds >= day && std::fmod(seconds, day) == 0;
    const std::string typed = days ? fmt::format("{:g}d", seconds / day) : fmt::format("{:g}s", seconds);
    quantity(app, name, seconds, parse_duration, unset.empty() ? typed : unset, range, help);
}

/// `unset`: what is shown for a default that is not a size.
void size(CLI::App& app, const std::string& name, std::size_t& bytes, const std::string& help,
          const std::string& unset = "") {
    const std::string typed = fmt::format("{}MiB", bytes >> 20);
    quantity(app, name, bytes, parse_size, unset.empty() ? typed : unset, {0, 1e18}, help);
}

void add_process_options(CLI::App& app, Config& config) {
    option(app, "listen", config.listen, "HOST:PORT; port 0 lets the system choose")->capture_default_str();
    option(app, "metrics-listen", config.metrics_listen,
           "Another HOST:PORT, for /metrics and probes only; it needs no key");
    option(app, "store", config.store, "Store of the jobs: sqlite:PATH or postgresql://USER@HOST/DATABASE")
        ->capture_default_str();
    option(app, "migrate", config.migrate,
           "auto: an older store is migrated at the start; manual: by `tunewright migrate`")
        ->capture_default_str();
    flag(app, "pooled", config.pooled,
         "PostgreSQL is behind a pooler in transaction mode: no notices, all processes poll");
    option(app, "role", config.role, "all; api (accepts requests, computes nothing) or worker (computes only)")
        ->capture_default_str();
    option(app, "workers", config.workers, "Jobs computed at the same time (default: one per core)")
        ->check(CLI::Range(1, 1024));
    size(app, "memory", config.memory, "Memory that the process may use; it bounds what is buffered for clients",
         "512MiB, or the limit of the control group");
    option(app, "web", config.web, "Folder of the built page (default: web next to the binary's folder)");
    duration(app, "drain-timeout", config.drain_timeout_s, {0, 3600},
             "Time for running jobs when the service is stopped");
    option(app, "log-format", config.log_format, "text or json, on standard error")->capture_default_str();
    option(app, "log-level", config.log_level, "debug, info, warn, error or off")->capture_default_str();
}

void add_job_options(CLI::App& app, Config& config) {
    option(app, "queue-limit", config.queue_limit, "Single jobs that may wait; more are answered 429")
        ->check(CLI::Range(1, 10'000'000))
        ->capture_default_str();
    option(app, "entry-limit", config.entry_limit, "Entries of batches that may wait; more are answered 429")
        ->check(CLI::Range(1, 100'000'000))
        ->capture_default_str();
    option(app, "client-jobs", config.client_jobs,
           "Single jobs of one key or address that may wait or run; more are answered 429; 0: no limit")
        ->check(CLI::Range(0, 10'000'000))
        ->capture_default_str();
    option(app, "max-attempts", config.max_attempts, "Interruptions after which a job fails")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    duration(app, "lease", config.lease_s, {0.5, 3600},
             "Time without a renewal after which another worker takes a job");
    duration(app, "retention", config.retention_s, {0, 1e9}, "Time for which ended jobs are kept; 0: without limit");
    duration(app, "retention-failed", config.retention_failed_s, {0, 1e9}, "Time for which failed jobs are kept",
             "as --retention");
    duration(app, "retention-cancelled", config.retention_cancelled_s, {0, 1e9},
             "Time for which cancelled jobs are kept", "as --retention");
    duration(app, "job-timeout", config.job_timeout_s, {0.1, 3600}, "Time limit of a job without timeout_s");
    duration(app, "max-timeout", config.max_timeout_s, {0.1, 3600}, "Largest timeout_s of a request");
}

void add_notify_options(CLI::App& app, Config& config) {
    option(app, "notify-target", config.notify_targets,
           "Allowed address of notifications: https://HOST[:PORT][/PATH]; may be repeated (default: none)")
        ->type_name("ORIGIN")
        ->delimiter(',');
    option(app, "notify-secrets", config.notify_secrets,
           "File of the secrets that sign notifications, made by `tunewright secret`");
}

void add_port_options(CLI::App& app, Config& config) {
    size(app, "max-body", config.max_body, "Largest body of one request; larger ones are answered 413");
    size(app, "max-batch-body", config.max_batch_body, "Largest body of one batch");
    option(app, "auth", config.auth, "none or keys: whether a call below /v1 needs a key")->capture_default_str();
    option(app, "keys", config.keys, "File of keys, made by `tunewright key`");
    flag(app, "allow-anonymous", config.allow_anonymous, "Listen beyond loopback without keys");
    option(app, "rate-limit", config.rate_limit, "Calls per second of one client; 0: no limit")
        ->check(number_within(0, 1e6))
        ->capture_default_str();
    option(app, "allowed-host", config.allowed_hosts,
           "A host name of the service, in addition to its address; may be repeated")
        ->type_name("NAME")
        ->delimiter(',');
    option(app, "cors-origin", config.cors_origins, "Another site whose pages may call; may be repeated")
        ->delimiter(',');
    flag(app, "behind-proxy", config.behind_proxy, "The client's address is the last one of X-Forwarded-For");
}

std::vector<std::string> environment() {
    std::vector<std::string> variables;
    for (char** each = environ; *each != nullptr; each++) variables.emplace_back(*each);
    return variables;
}

std::vector<std::string> variables_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* each : app.get_options())
        if (!each->get_envname().empty()) names.push_back(each->get_envname());
    return names;
}

}  // namespace

void add_serve_command(CommandTree& tree) {
    Config& config = tree.keep<Config>();
    CLI::App& app = tree.add("serve", "Run the service until SIGTERM or Ctrl-C", [&config] { return serve(config); });
    app.callback([&app, &config] { config.remarks = strange_variables(environment(), variables_of(app)); });
    add_process_options(app, config);
    add_job_options(app, config);
    add_notify_options(app, config);
    add_port_options(app, config);
}

}  // namespace tunewright::server
