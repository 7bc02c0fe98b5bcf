#include "bench/load/scenario.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace tunewright::load {
namespace {

/// A line such as "VmHWM:   12345 kB".
double status_mib(long pid, std::string_view name) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/status");
    for (std::string line; std::getline(file, line);)
        if (line.compare(0, name.size(), name) == 0) return std::strtod(line.c_str() + name.size() + 1, nullptr) / 1024;
    return 0;
}

std::size_t count_of(const std::string& json, std::string_view name) {
    return std::strtoul(json_value(json, name).c_str(), nullptr, 10);
}

}  // namespace

std::string rule_job(std::size_t number) {
    return R"({"plant": {"type": "fopdt", "K": 1, "T": )" + std::to_string(10 + number % 97) +
           R"(, "L": 2}, "tune": [{"method": "simc"}], "evaluate": {"points": 100}})";
}

std::string rule_lines(std::size_t count) {
    std::string lines;
    for (std::size_t i = 0; i < count; i++) lines.append(rule_job(i)).push_back('\n');
    return lines;
}

std::string json_value(std::string_view json, std::string_view name) {
    const std::string key = "\"" + std::string(name) + "\":";
    std::size_t at = json.find(key);
    if (at == std::string_view::npos) return "";
    at = json.find_first_not_of(' ', at + key.size());
    if (at == std::string_view::npos) return "";
    if (json[at] == '"') return std::string(json.substr(at + 1, json.find('"', at + 1) - at - 1));
    return std::string(json.substr(at, json.find_first_of(",}] \n", at) - at));
}

double peak_memory_mib(long pid) { return pid == 0 ? 0 : status_mib(pid, "VmHWM"); }
double memory_mib(long pid) { return pid == 0 ? 0 : status_mib(pid, "VmRSS"); }

std::string post_batch(Client& client, const std::string& lines) {
    const Answer answer =
        client.call(post("/v1/batches", lines, "Content-Type: application/x-ndjson\r\n"), std::chrono::seconds(300));
    if (answer.status != 202)
        throw std::runtime_error("the batch was answered with " + std::to_string(answer.status) + ": " +
                                 answer.body.substr(0, 300));
    return json_value(answer.body, "id");
}

std::size_t wait_for_batch(Client& client, const std::string& id, Clock::time_point end) {
    for (;;) {
        const Answer answer = client.call(get("/v1/batches/" + id));
        if (answer.status != 200)
            throw std::runtime_error("the batch is answered with " + std::to_string(answer.status));
        if (count_of(answer.body, "queued") + count_of(answer.body, "running") == 0)
            return count_of(answer.body, "succeeded");
        if (Clock::now() > end) throw std::runtime_error("the batch has not ended in time: " + answer.body);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
}

}  // namespace tunewright::load
