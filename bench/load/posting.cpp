// Scenarios of requests that are sent one after the other on each of several connections.
#include <algorithm>
#include <stdexcept>

#include "bench/load/scenario.h"

namespace tunewright::load {
namespace {

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Clock::time_point after(double seconds) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Sends request(0), request(1), ... until request(number) is asked for number `count`, as many at once as there are
/// connections. Returns the seconds from the first to the last answer.
double send_all(Client& client, const Options& options, std::size_t count,
                const std::function<std::string(std::size_t)>& request, int expected, AnswerLog& answers) {
    std::size_t next = 0;
    std::size_t open = 0;
    const auto end = after(options.patience);
    Client::Then then;
    const auto send_next = [&](Client::Id id) {
        if (next >= count) return;
        open++;
        client.send(id, request(next++), then);
    };
    then = [&](Client::Id id, const Answer& answer) {
        open--;
        answers.add(answer, answer.status == expected);
        send_next(id);
    };
    const auto start = Clock::now();
    std::vector<Client::Id> ids;
    for (std::size_t i = 0; i < options.connections; i++) ids.push_back(client.open());
    for (const Client::Id id : ids) send_next(id);
    client.run_until([&] { return open == 0; }, end);
    if (open > 0) throw std::runtime_error("gave up: " + std::to_string(open) + " requests have no answer");
    const double seconds = since(start);
    for (const Client::Id id : ids) client.close(id);
    return seconds;
}

bool list_is_empty(Client& client, const std::string& status) {
    const Answer answer = client.call(get("/v1/jobs?limit=1&status=" + status));
    return answer.status == 200 && answer.body.find("\"id\"") == std::string::npos;
}

void wait_until_idle(Client& client, double patience) {
    const auto end = after(patience);
    while (!list_is_empty(client, "queued") || !list_is_empty(client, "running")) {
        if (Clock::now() > end) throw std::runtime_error("the queue did not become empty");
        client.run_until([] { return false; }, after(0.02));
    }
}

}  // namespace

Figures health(const Options& options) {
    Client client(options.port);
    AnswerLog answers;
    const std::string request = get("/healthz");
    const auto start = Clock::now();
    const auto end = after(options.seconds);
    std::size_t open = options.connections;
    Client::Then then = [&](Client::Id id, const Answer& answer) {
        answers.add(answer, answer.status == 200);
        if (Clock::now() < end)
            client.send(id, request, then);
        else
            open--;
    };
    for (std::size_t i = 0; i < options.connections; i++) client.send(client.open(), request, then);
    client.run_until([&] { return open == 0; }, after(options.seconds + 10));
    Figures figures;
    figures.add(answers, since(start));
    return figures;
}

Figures post_jobs(const Options& options) {
    Client client(options.port);
    AnswerLog answers;
    const std::size_t count = options.count == 0 ? 8000 : options.count;
    const double seconds = send_all(
        client, options, count, [](std::size_t i) { return post("/v1/jobs", rule_job(i)); }, 202, answers);
    Figures figures;
    figures.add(answers, seconds);
    const auto rest = Clock::now();
    wait_until_idle(client, options.patience);
    figures.add("all ended after", seconds + since(rest), "s");
    return figures;
}

Figures finish_jobs(const Options& options) {
    Client client(options.port);
    AnswerLog answers;
    const std::size_t count = options.count == 0 ? 5000 : options.count;
    const bool waits = options.follow == "wait";
    const std::string fields = waits ? "Prefer: wait=60\r\n" : "";
    const auto start = Clock::now();
    send_all(
        client, options, count, [&](std::size_t i) { return post("/v1/jobs", rule_job(i), fields); }, waits ? 200 : 202,
        answers);
    if (!waits) wait_until_idle(client, options.patience);
    const double seconds = since(start);
    Figures figures;
    figures.add("finished", static_cast<double>(answers.count() - answers.errors()) / seconds, "/s");
    figures.add(answers, seconds);
    return figures;
}

Figures soak(const Options& options) {
    constexpr std::size_t kBatch = 10'000;
    Client client(options.port);
    AnswerLog answers;
    Figures figures;
    const std::size_t count = options.count == 0 ? 100'000 : options.count;
    const auto start = Clock::now();
    send_all(
        client, options, count - count / 2,
        [](std::size_t i) { return post("/v1/jobs", rule_job(i), "Prefer: wait=60\r\n"); }, 200, answers);
    figures.add("single peak", peak_memory_mib(options.pid), "MiB");
    std::size_t succeeded = 0;
    for (std::size_t done = 0; done < count / 2; done += kBatch) {
        const std::string id = post_batch(client, rule_lines(std::min(kBatch, count / 2 - done)));
        succeeded += wait_for_batch(client, id, after(options.patience));
        client.call(get("/v1/batches/" + id + "/results"), std::chrono::seconds(300));
    }
    const double seconds = since(start);
    figures.add("finished", static_cast<double>(answers.count() - answers.errors() + succeeded) / seconds, "/s");
    figures.add("errors", static_cast<double>(answers.errors() + count / 2 - succeeded));
    figures.add("peak memory", peak_memory_mib(options.pid), "MiB");
    figures.add("memory now", memory_mib(options.pid), "MiB");
    return figures;
}

}  // namespace tunewright::load
