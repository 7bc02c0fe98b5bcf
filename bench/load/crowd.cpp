// Scenarios in which one client is measured while others are connected.
#include <cstdio>
#include <stdexcept>

#include "bench/load/scenario.h"

namespace tunewright::load {
namespace {

constexpr std::size_t kIdle = 500;
constexpr std::size_t kStreams = 200;
constexpr std::size_t kWaiting = 200;
constexpr std::size_t kSlow = 50;
constexpr std::chrono::milliseconds kThink{5};

Clock::time_point after(double seconds) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Minutes of work: a grid search with surfaces on a plant of sixth order, forty times.
std::string long_job() {
    std::string tune;
    for (int i = 0; i < 40; i++) {
        char method[120];
        std::snprintf(method, sizeof method, R"(%s{"method": "robust", "search": "grid", "surface": true, "Ms": %.2f})",
                      i == 0 ? "" : ", ", 1.2 + 0.02 * i);
        tune += method;
    }
    return R"({"plant": {"type": "zpk", "zeros": [], "poles": [-1, -1.1, -1.2, -1.3, -1.4, -1.5], "K": 7.2, "L": 0.5},)"
           R"( "tune": [)" +
           tune + R"(], "timeout_s": 600})";
}

/// Robust PID designs by grid search: seconds of work each, so that posting and storing do not count.
std::string heavy_lines(std::size_t count) {
    std::string lines;
    for (std::size_t i = 0; i < count; i++)
        lines += R"({"plant": {"type": "sopdt", "K": 1, "T1": 10, "T2": )" + std::to_string(2 + i % 7) +
                 R"(, "L": 3}, "tune": [{"method": "robust", "search": "grid"}]})" + "\n";
    return lines;
}

/// Opens the crowd and keeps it there.
class Crowd {
public:
    Crowd(Client& client, const std::string& key) : client_(client) {
        for (std::size_t i = 0; i < kIdle; i++) {
            idle_.push_back(client_.open());
            client_.send(idle_.back(), get("/healthz"), [](Client::Id, const Answer&) {});
        }
        const std::string fields = "Idempotency-Key: " + key + "\r\n";
        job_ = json_value(client_.call(post("/v1/jobs", long_job(), fields)).body, "id");
        if (job_.empty()) throw std::runtime_error("the long job was refused");
        for (std::size_t i = 0; i < kStreams; i++) {
            streams_.push_back(client_.open());
            client_.send(streams_.back(), get("/v1/jobs/" + job_ + "/events"), [](Client::Id, const Answer&) {});
        }
        // The same key waits for the same job: two hundred requests, and one worker.
        for (std::size_t i = 0; i < kWaiting; i++) {
            waiting_.push_back(client_.open());
            client_.send(waiting_.back(), post("/v1/jobs", long_job(), fields + "Prefer: wait=60\r\n"),
                         [](Client::Id, const Answer&) {});
        }
        for (std::size_t i = 0; i < kSlow; i++) slow_.push_back({client_.open(), 0});
        client_.run_until([&] { return streams_open() == kStreams; }, after(10));
    }

    ~Crowd() { client_.call(post("/v1/jobs/" + job_ + "/cancel", "")); }
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;

    /// To be called often: slow clients send their byte each second, and come again when they are cut.
    void tick() {
        if (Clock::now() < next_byte_) return;
        next_byte_ = Clock::now() + std::chrono::seconds(1);
        const std::string request = post("/v1/jobs", rule_job(0));
        for (Slow& slow : slow_) {
            if (slow.sent < request.size() && client_.is_open(slow.id) &&
                client_.send_raw(slow.id, std::string_view(request).substr(slow.sent++, 1)))
                continue;
            client_.close(slow.id);
            slow = {client_.open(), 0};
            cut_++;
        }
    }

    std::size_t idle_open() const { return open_of(idle_); }
    std::size_t waiting_open() const { return open_of(waiting_); }
    std::size_t cut() const { return cut_; }
    std::size_t streams_open() const {
        std::size_t count = 0;
        for (const Client::Id id : streams_) count += client_.is_open(id) && client_.head_received(id) ? 1 : 0;
        return count;
    }

private:
    struct Slow {
        Client::Id id;
        std::size_t sent;
    };

    std::size_t open_of(const std::vector<Client::Id>& ids) const {
        std::size_t count = 0;
        for (const Client::Id id : ids) count += client_.is_open(id) ? 1 : 0;
        return count;
    }

    Client& client_;
    std::string job_;
    std::vector<Client::Id> idle_, streams_, waiting_;
    std::vector<Slow> slow_;
    std::size_t cut_ = 0;
    Clock::time_point next_byte_ = Clock::now();
};

}  // namespace

Figures interactive(const Options& options) {
    Client client(options.port);
    const std::size_t count = options.count == 0 ? 10'000 : options.count;
    const auto end = after(options.patience);
    AnswerLog beside;
    const std::string id = post_batch(client, rule_lines(count));
    const auto start = Clock::now();
    bool ended = false;
    auto next_look = Clock::now();
    while (!ended && Clock::now() < end) {
        const Answer answer = client.call(post("/v1/jobs", rule_job(beside.count()), "Prefer: wait=30\r\n"));
        const bool succeeded = answer.status == 200 && json_value(answer.body, "status") == "succeeded";
        // What was answered after the batch ended says nothing.
        if (Clock::now() >= next_look) {
            next_look = Clock::now() + std::chrono::milliseconds(200);
            const std::string batch = client.call(get("/v1/batches/" + id)).body;
            ended = json_value(batch, "queued") == "0" && json_value(batch, "running") == "0";
        }
        if (!ended) beside.add(answer, succeeded);
        client.run_until([] { return false; }, Clock::now() + kThink);
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    Figures figures;
    figures.add(beside, seconds);
    figures.add("measured", static_cast<double>(beside.count()));
    figures.add("batch", static_cast<double>(wait_for_batch(client, id, end)) / seconds, "/s");
    return figures;
}

Figures crowd(const Options& options) {
    Client client(options.port);
    Crowd others(client, "crowd-" + std::to_string(Clock::now().time_since_epoch().count()));
    const std::vector<std::string> requests = {
        get("/healthz"), post("/v1/jobs", rule_job(0), "Prefer: wait=30\r\n"),
        post("/v1/evaluate",
             R"({"plant": {"type": "fopdt", "K": 1, "T": 10, "L": 2}, "controllers": [{"form": "ideal",)"
             R"( "Kp": 1, "Ti": 10, "Td": 1}], "evaluate": {"points": 100}})"),
        get("/v1/jobs?limit=10")};
    AnswerLog answers;
    const Client::Id normal = client.open();
    const auto start = Clock::now();
    const auto end = after(options.seconds);
    for (std::size_t i = 0; Clock::now() < end; i++) {
        bool there = false;
        client.send(normal, requests[i % requests.size()], [&](Client::Id, const Answer& answer) {
            answers.add(answer, answer.status == 200);
            there = true;
        });
        const auto patience = after(options.patience);
        while (!there && Clock::now() < patience) {
            client.run_until([&] { return there; }, after(0.1));
            others.tick();
        }
        others.tick();
        client.run_until([] { return false; }, Clock::now() + kThink);
    }
    Figures figures;
    figures.add(answers, std::chrono::duration<double>(Clock::now() - start).count());
    figures.add("idle kept", static_cast<double>(others.idle_open()));
    figures.add("streams open", static_cast<double>(others.streams_open()));
    figures.add("waiting open", static_cast<double>(others.waiting_open()));
    figures.add("slow ones cut", static_cast<double>(others.cut()));
    if (options.pid != 0) figures.add("memory now", memory_mib(options.pid), "MiB");
    return figures;
}

Figures heavy_batch(const Options& options) {
    Client client(options.port);
    const std::size_t count = options.count == 0 ? 40 : options.count;
    const auto start = Clock::now();
    const std::string id = post_batch(client, heavy_lines(count));
    const std::size_t succeeded = wait_for_batch(client, id, after(options.patience));
    Figures figures;
    figures.add("time", std::chrono::duration<double>(Clock::now() - start).count(), "s");
    figures.add("errors", static_cast<double>(count - succeeded));
    return figures;
}

}  // namespace tunewright::load
