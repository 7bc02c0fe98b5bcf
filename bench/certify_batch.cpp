// How long the certified bound takes over the 94 plants of tests/data/robust, from their reference designs.
//
//   certify_batch [pi|pid_td10|pid_fixedTf] [gap] [seconds] [first] [step]
//
// prints one line a plant, then the number proved, the median and the worst time on two threads.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "engine/certificate/certificate.h"

namespace tunewright::bench {
namespace {

void on_two_threads(int n, const std::function<void(int)>& f) {
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int i = next++; i < n; i = next++) f(i);
    };
    std::thread other(work);
    work();
    other.join();
}

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Expected<CertificateProblem> problem_of(const nlohmann::json& row, const std::string& which) {
    const auto& given = row.at("plant");
    const auto& best = row.at(which == "pi" ? "pi_M1.4" : which == "pid_td10" ? "pid_M1.4_td10" : "pid_M1.4_fixedTf");
    const auto plant = LinearPlant::make(TransferFunction{given.at("num").get<std::vector<double>>(),
                                                          given.at("den").get<std::vector<double>>(),
                                                          given.at("delay").get<double>(),
                                                          {}});
    if (!plant) return plant.error();
    IdealPid pid{
        .Kp = best.at("K"), .Ti = best.at("Ti"), .Td = best.at("Td"), .b = 1, .c = 0, .filter = {}, .setpoint_lag = 0};
    if (pid.Td > 0)
        pid.filter = {FilterType::measurement_second_order,
                      which == "pid_td10" ? pid.Td / 10 : best.at("Tf").get<double>()};
    return certificate_problem(*plant, pid, 1.4, 1.4, best.at("IAE"));
}

}  // namespace
}  // namespace tunewright::bench

int main(int argc, char** argv) {
    using namespace tunewright;
    using namespace tunewright::bench;
    const std::string which = argc > 1 ? argv[1] : "pi";
    CertifyOptions options;
    options.gap = argc > 2 ? std::atof(argv[2]) : 0.01;
    const double limit = argc > 3 ? std::atof(argv[3]) : 60;
    const int first = argc > 4 ? std::atoi(argv[4]) : 0, step = argc > 5 ? std::atoi(argv[5]) : 1;
    options.keep_leaves = true;
    std::ifstream file(std::string(BENCH_DATA) + "/robust/public.json");
    const auto rows = nlohmann::json::parse(file).at("rows");
    std::vector<double> times;
    std::vector<int> boxes;
    int proved = 0;
    for (std::size_t i = static_cast<std::size_t>(first); i < rows.size(); i += static_cast<std::size_t>(step)) {
        const auto problem = problem_of(rows[i], which);
        if (!problem) {
            std::printf("%s: %s\n", rows[i].at("id").get<std::string>().c_str(), problem.error().message.c_str());
            continue;
        }
        std::stop_source stop;
        const double start = seconds();
        RunControl control;
        control.spread = on_two_threads;
        control.stop = stop.get_token();
        control.progress = [&](const Progress&) {
            if (seconds() - start > limit) stop.request_stop();
        };
        const auto found = certify(*problem, options, control);
        const double took = seconds() - start;
        times.push_back(took);
        const auto id = rows[i].at("id").get<std::string>();
        if (!found) {
            std::printf("%-16s %s\n", id.c_str(), found.error().message.c_str());
            continue;
        }
        proved += found->complete;
        boxes.push_back(found->boxes);
        const auto& by = found->leaves_by_reason;
        std::printf(
            "%-16s %s gap %.4f boxes %7d leaves S %d T %d error %d bound %d empty %d unstable %d phis %zu %.3f s\n",
            id.c_str(), found->complete ? "proved" : "OPEN  ", found->gap, found->boxes, by[0], by[1], by[2], by[3],
            by[4], by[5], found->phis.size(), took);
        std::fflush(stdout);
    }
    std::sort(times.begin(), times.end());
    std::sort(boxes.begin(), boxes.end());
    if (!boxes.empty())
        std::printf("%s, gap %g: %d of %zu proved; median %.3f s, worst %.3f s; boxes: median %d, worst %d\n",
                    which.c_str(), options.gap, proved, times.size(), times[times.size() / 2], times.back(),
                    boxes[boxes.size() / 2], boxes.back());
    return 0;
}
