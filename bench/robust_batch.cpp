// How long a robust design takes over the AMIGO batch: median, worst, total, one core. Every design is checked before
// its time counts: it must exist and hold its limits. A plant's time is the shortest of a few runs, which is what the
// machine takes undisturbed.
//
//   robust_batch [runs] [label]    prints a table in Markdown; with a label ("PID, fast") only that row, for a profile

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "bench/batch.h"
#include "engine/loop/peaks.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright::bench {
namespace {

struct Row {
    const char* label;
    const char* controller;
    const char* search;
};

struct Times {
    std::vector<double> ms;
    int failed = 0;
    int above_limit = 0;

    double total() const {
        double sum = 0;
        for (const double t : ms) sum += t;
        return sum;
    }
};

bool holds_limits(const LinearPlant& plant, const IdealPid& pid) {
    const auto loop = Loop::make(plant, to_parallel(pid));
    if (!loop) return false;
    const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
    return std::max(peaks.S.value, peaks.T.value) <= limits::kDefaultMs * (1 + limits::kMaxRelativeExcessVerified);
}

Times measure(const Row& row, int runs) {
    MethodOptions options;
    options.set("controller", std::string(row.controller));
    options.set("search", std::string(row.search));
    // As in the reference optima: the filter follows Td on every plant.
    if (std::string(row.controller) == "PID") options.set("filter/Tf_over_Td", 0.1);
    Times times;
    for (const auto& [name, plant] : amigo_batch()) {
        double best = 1e300;
        bool ok = true;
        for (int run = 0; run < runs; ++run) {
            const auto start = std::chrono::steady_clock::now();
            const auto linear = LinearPlant::make(plant);
            const TuningProblem problem{plant, *linear, std::nullopt};
            const auto tuned = find_method("robust")->tune(problem, options, {});
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
            best = std::min(best, took.count());
            ok = tuned.has_value();
            if (ok && run == 0) times.above_limit += !holds_limits(*linear, tuned->controller);
            if (!ok) break;
        }
        if (ok)
            times.ms.push_back(best);
        else
            ++times.failed;
    }
    std::sort(times.ms.begin(), times.ms.end());
    return times;
}

}  // namespace
}  // namespace tunewright::bench

int main(int argc, char** argv) {
    using namespace tunewright::bench;
    const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
    const std::string_view only = argc > 2 ? argv[2] : "";
    std::printf("| design | plants | median ms | worst ms | whole batch ms | without answer | above a limit |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const Row& row :
         {Row{"PID, fast", "PID", "fast"}, Row{"PI, fast", "PI", "fast"}, Row{"PID, nelder_mead", "PID", "nelder_mead"},
          Row{"PI, nelder_mead", "PI", "nelder_mead"}}) {
        if (!only.empty() && only != row.label) continue;
        const Times times = measure(row, runs);
        if (times.ms.empty()) continue;
        std::printf("| %s | %zu | %.2f | %.1f | %.0f | %d | %d |\n", row.label, times.ms.size(),
                    times.ms[times.ms.size() / 2], times.ms.back(), times.total(), times.failed, times.above_limit);
    }
    return 0;
}
