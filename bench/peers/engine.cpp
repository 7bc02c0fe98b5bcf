// The engine's side of the comparison. Lines of fields between tabs, a plant's name first:
//
//   peers_engine plants              name, num, den (descending powers, between spaces), dead time
//   peers_engine design SEARCH [pi]  name, Kp, Ti, Td, ms: the method `robust`, the shorter of two runs
//   peers_engine IAE < answers       name, load IAE to infinity of the Kp, Ti, Td after the name; nan where unstable

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <iostream>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "bench/batch.h"
#include "engine/evaluation/evaluate.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright::bench {
namespace {

constexpr double kTfOverTd = 0.1;
constexpr int kRuns = 2;

/// gain prod(s - root), real, in descending powers.
std::vector<double> polynomial(double gain, std::span<const std::complex<double>> roots, int at_origin = 0) {
    std::vector<std::complex<double>> p = {gain};
    const auto times = [&](std::complex<double> root) {
        p.emplace_back(0);
        for (std::size_t i = p.size() - 1; i > 0; --i) p[i] -= root * p[i - 1];
    };
    for (const auto& root : roots) times(root);
    for (int i = 0; i < at_origin; ++i) times(0);
    std::vector<double> real;
    for (const auto& c : p) real.push_back(c.real());
    return real;
}

void print(const std::vector<double>& coefficients) {
    for (std::size_t i = 0; i < coefficients.size(); ++i) std::printf(i ? " %.15g" : "\t%.15g", coefficients[i]);
}

void print_plants() {
    for (const auto& [name, plant] : amigo_batch()) {
        const auto linear = LinearPlant::make(plant);
        std::printf("%s", name.c_str());
        print(polynomial(linear->gain(), linear->zeros()));
        print(polynomial(1, linear->poles(), linear->integrators()));
        std::printf("\t%.15g\n", linear->dead_time());
    }
}

void print_designs(const std::string& search, bool pi) {
    MethodOptions options;
    options.set("search", search);
    if (pi)
        options.set("controller", std::string("PI"));
    else
        options.set("filter/Tf_over_Td", kTfOverTd);
    for (const auto& [name, plant] : amigo_batch()) {
        double best = INFINITY;
        IdealPid pid;
        for (int run = 0; run < kRuns; ++run) {
            const auto start = std::chrono::steady_clock::now();
            const auto linear = LinearPlant::make(plant);
            const auto tuned = find_method("robust")->tune({plant, *linear, std::nullopt}, options, {});
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
            if (!tuned) break;
            best = std::min(best, took.count());
            pid = tuned->controller;
        }
        if (std::isfinite(best))
            std::printf("%s\t%.12g\t%.12g\t%.12g\t%.6g\n", name.c_str(), pid.Kp, pid.Ti, pid.Td, best);
    }
}

double load_iae(const Plant& plant, const IdealPid& pid) {
    EvaluateOptions options;
    options.points = 0;
    const auto evaluation = evaluate(plant, pid, options);
    return evaluation ? evaluation->performance.load.IAE.value_or(NAN) : NAN;
}

void print_load_iae() {
    std::map<std::string, Plant> plants;
    for (auto& [name, plant] : amigo_batch()) plants.emplace(name, std::move(plant));
    for (std::string line; std::getline(std::cin, line);) {
        const auto tab = line.find('\t');
        const auto plant = plants.find(line.substr(0, tab));
        if (tab == std::string::npos || plant == plants.end()) continue;
        IdealPid pid;
        std::istringstream(line.substr(tab)) >> pid.Kp >> pid.Ti >> pid.Td;
        if (pid.Td > 0) pid.filter = {FilterType::measurement_second_order, kTfOverTd * pid.Td};
        std::printf("%s\t%.9g\n", plant->first.c_str(), load_iae(plant->second, pid));
    }
}

}  // namespace
}  // namespace tunewright::bench

int main(int argc, char** argv) {
    using namespace tunewright::bench;
    const std::string command = argc > 1 ? argv[1] : "";
    if (argc > 1 && std::string(argv[argc - 1]) == "--version")
        std::puts(TUNEWRIGHT_VERSION);
    else if (command == "plants")
        print_plants();
    else if (command == "design" && argc > 2)
        print_designs(argv[2], argc > 3 && std::string(argv[3]) == "pi");
    else if (command == "IAE")
        print_load_iae();
    else
        return std::fprintf(stderr, "peers_engine plants | design SEARCH [pi] | IAE\n"), 2;
    return 0;
}
