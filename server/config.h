// The configuration of the process, from its options and variables at the start.
#pragma once

#include <string>
#include <vector>

namespace tunewright::server {

/// The part of the service that this process performs. `api` accepts requests and computes nothing; `worker` computes
/// and answers only probes and metrics.
enum class ProcessRole { all, api, worker };

/// Defaults are shown by `serve --help`; OptionsTest of tests/server/deploy/deploy_test.py lists what repeats one.
struct Config {
    std::string listen = "127.0.0.1:8080";  ///< HOST:PORT; [::1]:8080 for IPv6; port 0: the system chooses
    std::string store = "sqlite:tunewright.db";
    std::string migrate = "auto";     ///< or manual: `tunewright migrate` updates the store's tables
    bool pooled = false;              ///< PostgreSQL is behind a pooler in transaction mode
    std::string role = "all";         ///< or api, worker
    std::size_t workers = 0;          ///< 0: as many as there are cores
    std::size_t memory = 0;           ///< bytes that the process may use; 0: see memory_limit()
    std::string web;                  ///< "": `web` next to the folder of the binary
    double drain_timeout_s = 5;       ///< time for running jobs when the service is stopped
    std::string log_format = "text";  ///< or json
    std::string log_level = "info";   ///< debug, info, warn, error

    std::string metrics_listen;  ///< another address, for metrics and probes only, without keys; "": none

    // Jobs
    std::size_t queue_limit = 10'000;     ///< single jobs that may wait
    std::size_t entry_limit = 1'000'000;  ///< entries of batches that may wait
    std::size_t client_jobs = 0;          ///< single jobs of one client that may wait or run; 0: no limit
    int max_attempts = 10;
    double lease_s = 10;
    double retention_s = 7 * 86400;  ///< 0: without limit
    double retention_failed_s = -1;  ///< for failed jobs; 0: without limit, negative: as for the others
    double retention_cancelled_s = -1;
    double job_timeout_s = 60;
    double max_timeout_s = 3600;

    // Notifications
    std::vector<std::string> notify_targets;  ///< allowed targets, ORIGIN[/PATH]; none: no notifications
    std::string notify_secrets;               ///< the file with the secrets that sign notifications

    // The server
    std::size_t max_body = 8 << 20;          ///< bytes of one request
    std::size_t max_batch_body = 256 << 20;  ///< bytes of one batch
    std::string auth = "none";               ///< or keys
    std::string keys;                        ///< the file of keys
    bool allow_anonymous = false;            ///< beyond loopback without keys
    double rate_limit = 0;                   ///< calls per second of one client; 0: no limit
    std::vector<std::string> allowed_hosts;  ///< names of the service, in addition to its address
    std::vector<std::string> cors_origins;
    bool behind_proxy = false;

    std::vector<std::string> remarks;  ///< on the source of the settings, for the log
};

struct HostPort {
    std::string host;
    int port = 0;
};

/// Throws std::invalid_argument with a sentence if the text is not valid.
HostPort parse_listen(const std::string& text);
ProcessRole parse_role(const std::string& text);
/// Bytes of "8" (MiB), "512KiB", "8MiB", "1GiB". A plain number of more than 65,536 is one of bytes.
std::size_t parse_size(const std::string& text);
/// Seconds of "10", "10s", "500ms", "5min", "12h", "7d".
double parse_duration(const std::string& text);

/// Throws std::invalid_argument with a sentence for options that exclude each other: an address beyond loopback without
/// keys, keys without a file, a worker on a store for one process, a longest timeout below the default one.
void check_config(const Config& config);

/// The folder of the page: build/release/tunewright -> build/web; /usr/bin/tunewright -> /usr/share/tunewright/web
std::string default_web_folder();

std::size_t core_count();

}  // namespace tunewright::server
