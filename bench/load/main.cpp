// The load client's command line: load SCENARIO --port N [--json] [...]. Exit code 1 where a request went wrong.
#include <cstdlib>
#include <iostream>
#include <map>
#include <stdexcept>

#include "bench/load/scenario.h"

namespace tunewright::load {
namespace {

constexpr const char* kUsage =
    "load SCENARIO [--port N] [--json] [--connections N] [--count N] [--seconds S] [--patience S] [--pid N]\n"
    "              [--follow wait|poll] [--key KEY]\n"
    "  health        GET /healthz, kept alive, for --seconds\n"
    "  post          durable POST /v1/jobs, --count of them\n"
    "  jobs          --count SIMC designs from the post to their end; --follow says how it is noticed\n"
    "  interactive   one client that waits for single designs while a batch of --count runs\n"
    "  soak          --count designs, half single, half in batches; --pid: the server's peak memory\n"
    "  crowd         a normal client for --seconds, with 500 idle connections, 200 event streams, 200 waiting\n"
    "                requests and 50 clients of one byte a second\n"
    "  replicas      the time of a batch of --count robust PID designs by grid search\n";

using Scenario = Figures (*)(const Options&);

const std::map<std::string, Scenario>& scenarios() {
    static const std::map<std::string, Scenario> known = {
        {"health", health}, {"post", post_jobs}, {"jobs", finish_jobs},     {"interactive", interactive},
        {"soak", soak},     {"crowd", crowd},    {"replicas", heavy_batch},
    };
    return known;
}

struct CommandLine {
    Options options;
    bool json = false;
};

CommandLine read(int count, char** words) {
    CommandLine read;
    for (int i = 2; i < count; i++) {
        const std::string name = words[i];
        if (name == "--json") {
            read.json = true;
            continue;
        }
        if (i + 1 >= count) throw std::invalid_argument(name + " needs a value, or is not known");
        const char* value = words[++i];
        Options& options = read.options;
        if (name == "--port")
            options.port = std::atoi(value);
        else if (name == "--pid")
            options.pid = std::atol(value);
        else if (name == "--connections")
            options.connections = std::strtoul(value, nullptr, 10);
        else if (name == "--count")
            options.count = std::strtoul(value, nullptr, 10);
        else if (name == "--seconds")
            options.seconds = std::atof(value);
        else if (name == "--patience")
            options.patience = std::atof(value);
        else if (name == "--follow")
            options.follow = value;
        else if (name == "--key")
            send_always("Authorization: Bearer " + std::string(value) + "\r\n");
        else
            throw std::invalid_argument(name + " is not known");
    }
    return read;
}

int run(int count, char** words) {
    const auto found = scenarios().find(count > 1 ? words[1] : "");
    if (found == scenarios().end()) {
        std::cerr << kUsage;
        return 2;
    }
    try {
        const CommandLine given = read(count, words);
        const Figures figures = found->second(given.options);
        if (given.json)
            std::cout << figures.json() << "\n";
        else
            std::cout << found->first << "\n" << figures.text();
        return figures.value("errors") > 0 ? 1 : 0;
    } catch (const std::invalid_argument& error) {
        std::cerr << error.what() << "\n" << kUsage;
        return 2;
    } catch (const std::exception& error) {
        std::cerr << found->first << ": " << error.what() << "\n";
        return 1;
    }
}

}  // namespace
}  // namespace tunewright::load

int main(int count, char** words) { return tunewright::load::run(count, words); }
