// The command line of the one binary: its options and commands, each of which is a function elsewhere.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <exception>
#include <iostream>
#include <stdexcept>

#include "api/service.h"
#include "server/access/keys.h"
#include "server/commands.h"
#include "server/config.h"
#include "server/notify/secrets.h"
#include "server/serve.h"
#include "server/store/open_store.h"

namespace {

using tunewright::server::Config;

/// Each option has a variable of the same name: --max-body is TUNEWRIGHT_MAX_BODY.
std::string variable_of(const std::string& name) {
    std::string variable = "TUNEWRIGHT_";
    for (const char c : name)
        variable.push_back(c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
    return variable;
}

template <class T>
CLI::Option* option(CLI::App& app, const std::string& name, T& value, const std::string& help) {
    return app.add_option("--" + name, value, help)->envname(variable_of(name));
}

void flag(CLI::App& app, const std::string& name, bool& value, const std::string& help) {
    app.add_flag("--" + name, value, help)->envname(variable_of(name));
}

/// An option that is typed with a unit and kept as a number; `shown` is the default as one would type it.
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

void duration(CLI::App& app, const std::string& name, double& seconds, const std::string& shown,
              std::pair<double, double> range, const std::string& help) {
    quantity(app, name, seconds, tunewright::server::parse_duration, shown, range, help);
}

void size(CLI::App& app, const std::string& name, std::size_t& bytes, const std::string& shown,
          const std::string& help) {
    quantity(app, name, bytes, tunewright::server::parse_size, shown, {0, 1e18}, help);
}

void add_process_options(CLI::App& app, Config& config) {
    option(app, "listen", config.listen, "HOST:PORT; port 0 lets the system choose")->capture_default_str();
    option(app, "metrics-listen", config.metrics_listen,
           "Another HOST:PORT, for /metrics and probes alone; it asks for no key");
    option(app, "store", config.store, "Where jobs are kept: sqlite:PATH or postgresql://USER@HOST/DATABASE")
        ->capture_default_str();
    option(app, "migrate", config.migrate,
           "auto: the tables of an older store are brought up to date at the start; manual: by `tunewright migrate`")
        ->capture_default_str();
    flag(app, "pooled", config.pooled,
         "PostgreSQL is behind a pooler in transaction mode: no notices, all processes poll");
    option(app, "role", config.role, "all; api (takes requests, computes nothing) or worker (computes only)")
        ->capture_default_str();
    option(app, "workers", config.workers, "Jobs computed at the same time (default: one a core)")
        ->check(CLI::Range(1, 1024));
    option(app, "web", config.web, "Folder of the built page (default: web beside the binary's folder)");
    duration(app, "drain-timeout", config.drain_timeout_s, "5s", {0, 3600},
             "Time that running jobs get when the service is stopped");
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
    option(app, "max-attempts", config.max_attempts, "Interruptions after which a job fails")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    duration(app, "lease", config.lease_s, "10s", {0.5, 3600},
             "Time without a sign of life after which another worker takes a job");
    duration(app, "retention", config.retention_s, "7d", {0, 1e9}, "How long ended jobs are kept; 0: without limit");
    duration(app, "retention-failed", config.retention_failed_s, "as --retention", {0, 1e9},
             "The same for jobs that failed, where it differs");
    duration(app, "retention-cancelled", config.retention_cancelled_s, "as --retention", {0, 1e9},
             "The same for jobs that were cancelled");
    duration(app, "job-timeout", config.job_timeout_s, "60s", {0.1, 3600},
             "Time for a job that does not say timeout_s");
    duration(app, "max-timeout", config.max_timeout_s, "3600s", {0.1, 3600},
             "Longest timeout_s that a request may ask for");
}

void add_notify_options(CLI::App& app, Config& config) {
    option(app, "notify-target", config.notify_targets,
           "Where a job's or batch's notify may lead: https://HOST[:PORT][/PATH]; may be repeated (default: nowhere)")
        ->type_name("ORIGIN")
        ->delimiter(',');
    option(app, "notify-secrets", config.notify_secrets,
           "File of the secrets that sign it, made by `tunewright secret`");
}

void add_port_options(CLI::App& app, Config& config) {
    size(app, "max-body", config.max_body, "8MiB", "Largest body of one request; larger ones are answered 413");
    size(app, "max-batch-body", config.max_batch_body, "256MiB", "Largest body of one batch");
    option(app, "auth", config.auth, "none or keys: what a call below /v1 must show")->capture_default_str();
    option(app, "keys", config.keys, "File of keys, made by `tunewright key`");
    flag(app, "allow-anonymous", config.allow_anonymous, "Listen beyond loopback without keys");
    option(app, "rate-limit", config.rate_limit, "Calls a second that one client may make; 0: no limit")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    option(app, "allowed-host", config.allowed_hosts,
           "A name by which it is called, beside its address; may be repeated")
        ->type_name("NAME");
    option(app, "cors-origin", config.cors_origins, "Another site whose pages may call; may be repeated")
        ->delimiter(',');
    flag(app, "behind-proxy", config.behind_proxy, "A client is the last address of X-Forwarded-For");
}

void add_serve_options(CLI::App& app, Config& config) {
    add_process_options(app, config);
    add_job_options(app, config);
    add_notify_options(app, config);
    add_port_options(app, config);
}

/// An option of the command that is a parameter of the call too, under the same name: --sample-time is sample_time.
void code_word(CLI::App& app, const std::string& name, tunewright::api::CodeWords& words, const std::string& help) {
    std::string parameter = name;
    std::replace(parameter.begin(), parameter.end(), '-', '_');
    app.add_option_function<std::string>(
           "--" + name, [&words, parameter](const std::string& word) { words.emplace_back(parameter, word); }, help)
        ->type_name("WORD");
}

void add_code_options(CLI::App& app, tunewright::server::CodeCommand& command) {
    app.add_option("file", command.file, "A result of tune, or a job as JSON; - reads standard input")->required();
    app.add_option("--controller", command.controller, "Number in the result, from 0 (default: the best)");
    app.add_option("--request", command.request, "File of the request, for the head comment and its sample time");
    auto& words = command.words;
    code_word(app, "language", words, "st, c or python");
    code_word(app, "sample-time", words, "Time from call to call, in the result's unit of time");
    code_word(app, "integral", words, "backward, forward or trapezoidal");
    code_word(app, "derivative", words,
              "difference, filtered_backward, filtered_forward, filtered_trapezoidal, slope or four_points");
    code_word(app, "slope-samples", words, "Sample times that the rule slope spans");
    code_word(app, "form", words, "position or velocity");
    code_word(app, "anti-windup", words, "back_calculation or clamping");
    code_word(app, "tracking-time", words, "Tracking time of back-calculation");
    code_word(app, "u-min", words, "Least u");
    code_word(app, "u-max", words, "Largest u");
    code_word(app, "rate-limit", words, "Most that u moves in a unit of time");
    code_word(app, "bias", words, "u at the operating point");
    code_word(app, "y0", words, "y at the operating point");
}

}  // namespace

int main(int argc, char** argv) {
    using namespace tunewright::server;
    CLI::App app("Tunes PID controllers: a plant or a recorded test in, controllers with their robustness out.");
    app.name("tunewright");
    app.set_version_flag("--version", "tunewright " TUNEWRIGHT_VERSION);
    app.require_subcommand(1);

    Config config;
    CLI::App* serving = app.add_subcommand("serve", "Answer over HTTP until SIGTERM or Ctrl-C");
    add_serve_options(*serving, config);

    std::string file;
    CLI::App* tuning = app.add_subcommand("tune", "Answer one tuning request: result on stdout, problem on stderr");
    tuning->add_option("file", file, "The request as JSON; - reads standard input")->required();

    IdentifyCommand identifying;
    CLI::App* identify_app =
        app.add_subcommand("identify", "A model from a recorded test: model on stdout, problem on stderr");
    identify_app->add_option("file", identifying.file, "CSV, or {record, identify} as JSON; - reads standard input")
        ->required();
    identify_app->add_option("--t", identifying.question.t, "CSV: heading or number of the time column");
    identify_app->add_option("--u", identifying.question.u, "CSV: heading or number of the controller output");
    identify_app->add_option("--y", identifying.question.y, "CSV: heading or number of the measurement");
    identify_app->add_option("--r", identifying.question.r,
                             "CSV: heading or number of the set point, where there is one");
    identify_app->add_option("--dt", identifying.question.dt, "CSV without times: their spacing");
    identify_app->add_option("--time-unit", identifying.question.time_unit,
                             "CSV: unit of every time of the answer; s if not given");
    identify_app->add_option("--kind", identifying.question.kind, "CSV: auto, step, relay or general");
    identify_app->add_option("--model", identifying.question.model,
                             "CSV: auto, fopdt, sopdt, sopdt_zero, ipdt or ipdt_lag");
    identify_app->add_option("--u-limits", identifying.question.u_limits, "CSV: the ends of the actuator, low and high")
        ->expected(2);
    identify_app->add_flag("--traces", identifying.question.traces,
                           "CSV: answer the record beside the models' free runs too");

    PlantCommand typing;
    CLI::App* plant_app =
        app.add_subcommand("plant", "A typed plant such as \"2 e^(-3s)/(10s+1)\" as JSON, with its formula");
    plant_app->add_option("text", typing.text, "The plant; - reads standard input")->required();
    plant_app->add_option("--time-unit", typing.time_unit, "Unit of the times of the answer; s if not given");

    CodeCommand coding;
    CLI::App* code_app = app.add_subcommand("code", "A controller of a result as Structured Text, C or Python");
    add_code_options(*code_app, coding);

    ReportCommand reporting;
    CLI::App* report_app = app.add_subcommand("report", "A controller of a result as a page to print, in HTML");
    report_app->add_option("file", reporting.file, "A result of tune, or a job as JSON; - reads standard input")
        ->required();
    report_app->add_option("--controller", reporting.controller, "Number in the result, from 0 (default: the best)");
    report_app->add_option("--request", reporting.request, "File of the request, where the result does not have it");

    KeyCommand naming;
    CLI::App* methods_app = app.add_subcommand("methods", "The tuning methods with their options, as JSON");
    CLI::App* controllers_app =
        app.add_subcommand("controllers", "The controllers that settings can be converted for, as JSON");
    CLI::App* key_app = app.add_subcommand("key", "Make an API key: printed once on stdout, its digest kept in a file");
    key_app->add_option("name", naming.name, "Name of the owner, to whom jobs belong")->required();
    key_app->add_option("--keys", naming.file, "The file it is added to (default: the line goes to stderr)");
    key_app->add_flag("--admin", naming.admin, "For whoever runs the service: sees and acts on everybody's jobs");

    tunewright::server::MigrateCommand migrating;
    migrating.store = config.store;
    CLI::App* migrate_app =
        app.add_subcommand("migrate", "Bring the tables of a store up to date, and say what was done");
    option(*migrate_app, "store", migrating.store, "The store, as `serve` has it")->capture_default_str();
    migrate_app->add_option("--grant", migrating.grant, "A role of PostgreSQL that may then run the service");
    migrate_app->add_flag("--compact", migrating.compact, "Write a SQLite file anew, without what deleted jobs left");

    SecretCommand sharing;
    CLI::App* secret_app = app.add_subcommand(
        "secret", "Make a secret that signs what others are told of ends: printed on stdout, kept in a file");
    secret_app->add_option("name", sharing.name, "Its name, which a request gives as notify.secret_id")->required();
    secret_app->add_option("--file", sharing.file, "The file it is added to (default: the line goes to stderr)");

    std::string asked;
    CLI::App* health_app = app.add_subcommand("health", "Ask a running service whether it is well: exit code 0 if so");
    health_app->add_option("url", asked, "Default: /healthz of this machine's service, by TUNEWRIGHT_LISTEN");
    std::string listening = config.listen;
    option(*health_app, "listen", listening, "HOST:PORT of that service");

    CLI11_PARSE(app, argc, argv);
    try {
        if (health_app->parsed()) return check_health(asked.empty() ? health_url(listening) : asked);
        if (key_app->parsed()) return make_key(naming);
        if (migrate_app->parsed()) return migrate_store(migrating, std::cout), 0;
        if (secret_app->parsed()) return make_secret(sharing);
        if (identify_app->parsed()) return identify(identifying);
        if (plant_app->parsed()) return plant(typing);
        if (code_app->parsed()) return code(coding);
        if (report_app->parsed()) return report(reporting);
        if (methods_app->parsed()) {
            std::cout << tunewright::api::methods_json() << "\n";
            return 0;
        }
        if (controllers_app->parsed()) {
            std::cout << tunewright::api::controllers_json() << "\n";
            return 0;
        }
        return serving->parsed() ? serve(config) : tune(file);
    } catch (const std::exception& fault) {
        std::cerr << "tunewright: " << fault.what() << "\n";
        return 1;
    }
}
