// The command line of the one binary; everything else is behind serve() and tune().
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "server/config.h"
#include "server/identify_command.h"
#include "server/serve.h"
#include "server/tune_command.h"

int main(int argc, char** argv) {
    using namespace tunewright::server;
    CLI::App app("Tunes PID controllers: a plant or a recorded test in, controllers with their robustness out.");
    app.name("tunewright");
    app.set_version_flag("--version", "tunewright " TUNEWRIGHT_VERSION);
    app.require_subcommand(1);

    Config config;
    CLI::App* serving = app.add_subcommand("serve", "Answer over HTTP until SIGTERM or Ctrl-C");
    serving->add_option("--listen", config.listen, "HOST:PORT; port 0 lets the system choose")
        ->envname("TUNEWRIGHT_LISTEN")
        ->capture_default_str();
    serving->add_option("--store", config.store, "Where jobs are kept: sqlite:PATH")
        ->envname("TUNEWRIGHT_STORE")
        ->capture_default_str();
    serving->add_option("--workers", config.workers, "Jobs computed at the same time (default: one a core)")
        ->envname("TUNEWRIGHT_WORKERS")
        ->check(CLI::Range(1, 1024));
    serving->add_option("--queue-limit", config.queue_limit, "Jobs that may wait; more are answered 429")
        ->envname("TUNEWRIGHT_QUEUE_LIMIT")
        ->check(CLI::Range(1, 10'000'000))
        ->capture_default_str();
    serving
        ->add_option("--body-limit", config.body_limit_mib,
                     "Most of one request's body, in MiB; longer ones are answered 413")
        ->envname("TUNEWRIGHT_BODY_LIMIT")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    serving->add_option("--web", config.web, "Folder of the built page (default: web beside the binary's folder)")
        ->envname("TUNEWRIGHT_WEB");
    serving->add_option("--log-format", config.log_format, "plain or json, on standard error")
        ->envname("TUNEWRIGHT_LOG_FORMAT")
        ->capture_default_str();
    serving->add_option("--log-level", config.log_level, "debug, info, warn, error or off")
        ->envname("TUNEWRIGHT_LOG_LEVEL")
        ->capture_default_str();
    serving->add_option("--grace", config.grace_s, "Seconds that running jobs get when the service is stopped")
        ->envname("TUNEWRIGHT_GRACE")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();

    std::string file;
    CLI::App* tuning = app.add_subcommand("tune", "Answer one tuning request: result on stdout, problem on stderr");
    tuning->add_option("file", file, "The request as JSON; - reads standard input")->required();

    IdentifyCommand identifying;
    CLI::App* identify_app =
        app.add_subcommand("identify", "A model from a recorded test: model on stdout, problem on stderr");
    identify_app->add_option("file", identifying.file, "CSV, or {record, identify} as JSON; - reads standard input")
        ->required();
    identify_app->add_option("--t", identifying.question.t, "CSV: heading or number of the time column");
    identify_app->add_option("--u", identifying.question.u, "CSV: of the controller output");
    identify_app->add_option("--y", identifying.question.y, "CSV: of the measurement");
    identify_app->add_option("--dt", identifying.question.dt, "CSV without times: their spacing");
    identify_app->add_option("--time-unit", identifying.question.time_unit,
                             "CSV: unit of every time of the answer; s if not given");
    identify_app->add_option("--kind", identifying.question.kind, "CSV: auto, step, relay or general");
    identify_app->add_option("--model", identifying.question.model,
                             "CSV: auto, fopdt, sopdt, sopdt_zero, ipdt or ipdt_lag");

    CLI11_PARSE(app, argc, argv);
    try {
        if (identify_app->parsed()) return identify(identifying);
        return serving->parsed() ? serve(config) : tune(file);
    } catch (const std::exception& fault) {
        std::cerr << "tunewright: " << fault.what() << "\n";
        return 1;
    }
}
