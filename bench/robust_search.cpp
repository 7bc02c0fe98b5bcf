// How near to the best known design the search `fast` ends: 300 random plants, 100 of them resonant, at limits Ms = Mt
// from 1.2 to 2. The best known is the best of the three searches and of 20 random starts.
//
//   robust_search [plants] [objective] [first]     prints tables in Markdown; those above 0.1 % one by one

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/engine/tuning/best_known_design.h"

namespace tunewright::bench {
namespace {

using namespace tunewright::test;

constexpr int kRandomStarts = 20;
constexpr double kAllowed = 1e-3;

struct Comparison {
    bool answered = false;
    double above = 0;  ///< relative, of the best known cost
    double ms = 0;
    std::string best_by;
    IdealPid fast;
};

double now_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::optional<Comparison> compare(const DesignTask& task, std::uint64_t seed) {
    const LinearPlant linear = *LinearPlant::make(task.plant);
    Comparison result;
    const double start = now_ms();
    const auto fast = designed(task, "fast");
    result.ms = now_ms() - start;
    result.answered = fast.has_value();
    const auto simplex = designed(task, "nelder_mead"), grid = designed(task, "grid");
    const auto& any = fast ? fast : simplex ? simplex : grid;
    if (!any) return std::nullopt;
    robust::DesignProblem problem = problem_of(task, linear, any->controller);
    set_reference_optima(task, problem);
    std::optional<double> best;
    const auto take = [&](const char* name, std::optional<double> cost) {
        if (!cost || (best && *best <= *cost)) return;
        best = cost;
        result.best_by = name;
    };
    std::optional<double> own;
    if (fast) take("fast", own = checked_cost(problem, point_of(fast->controller)));
    if (fast) result.fast = fast->controller;
    if (simplex) take("nelder_mead", checked_cost(problem, point_of(simplex->controller)));
    if (grid) take("grid", checked_cost(problem, point_of(grid->controller)));
    take("random starts", best_from_random_starts(problem, kRandomStarts, seed));
    if (!best) return std::nullopt;
    result.answered = own.has_value();
    result.above = own ? *own / *best - 1 : INFINITY;
    return result;
}

void print_row(const char* label, std::vector<Comparison> rows) {
    std::vector<double> above, ms;
    int missed = 0, without = 0;
    for (const auto& row : rows) {
        without += !row.answered;
        missed += !(row.above <= kAllowed);
        if (row.answered) above.push_back(row.above);
        ms.push_back(row.ms);
    }
    if (above.empty()) return;
    std::sort(above.begin(), above.end());
    std::sort(ms.begin(), ms.end());
    std::printf("| %s | %zu | %d | %.4f | %.4f | %d | %.2f | %.1f |\n", label, rows.size(), without,
                100 * above[above.size() * 95 / 100], 100 * above.back(), missed, ms[ms.size() / 2], ms.back());
}

}  // namespace
}  // namespace tunewright::bench

int main(int argc, char** argv) {
    using namespace tunewright::bench;
    const int plants = argc > 1 ? std::max(3, std::atoi(argv[1])) : 300;
    const int first = argc > 3 ? std::atoi(argv[3]) : 0;
    std::vector<std::string> objectives = {"load_iae", "setpoint_iae", "weighted", "load_ie"};
    if (argc > 2 && std::string(argv[2]) != "all") objectives = {argv[2]};
    for (const auto& objective : objectives) {
        std::vector<Comparison> resonant, ordinary;
        for (int i = first; i < first + plants; ++i) {
            const RandomPlant drawn = random_plant(static_cast<std::uint64_t>(i), i % 3 == 0);
            const auto row = compare({drawn.plant, drawn.M, objective}, static_cast<std::uint64_t>(i));
            if (!row) continue;
            (drawn.resonant ? resonant : ordinary).push_back(*row);
            if (row->above > kAllowed)
                std::printf("%s, %s, M %.3f: %.3f %% above %s (Kp %.4g Ti %.4g Td %.4g Tf %.3g)\n", objective.c_str(),
                            drawn.description.c_str(), drawn.M, 100 * row->above, row->best_by.c_str(), row->fast.Kp,
                            row->fast.Ti, row->fast.Td, row->fast.filter.Tf);
        }
        std::printf(
            "\n| %s | designs | without | 95 %% are within %% | worst %% | above 0.1 %% | median ms | worst ms |\n",
            objective.c_str());
        std::printf("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
        print_row("ordinary", ordinary);
        print_row("resonant", resonant);
        std::fflush(stdout);
    }
    return 0;
}
