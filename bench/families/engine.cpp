// The engine's side: designs a robust PID for each plant of the standard input, the filter by the method's own rule.
//
//   families_engine < plants      a line: name, Ms = Mt, K, dead time, zeros, poles; fields between tabs, a root's real
//                                 and imaginary part between spaces
//
// A line of the answer: name, ms (the shorter of two runs), then Kp, Ti, Td, Tf, or the sentence that says why not.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright::bench {
namespace {

constexpr int kRuns = 2;

std::vector<std::complex<double>> roots(const std::string& field) {
    std::vector<std::complex<double>> all;
    std::istringstream text(field);
    for (double re = 0, im = 0; text >> re >> im;) all.emplace_back(re, im);
    return all;
}

void design(const std::string& line) {
    std::istringstream text(line);
    std::vector<std::string> fields;
    for (std::string field; std::getline(text, field, '\t');) fields.push_back(field);
    fields.resize(6);
    MethodOptions options;
    options.set("Ms", std::stod(fields[1]));
    options.set("Mt", std::stod(fields[1]));
    const Zpk plant{
        .K = std::stod(fields[2]), .zeros = roots(fields[4]), .poles = roots(fields[5]), .L = std::stod(fields[3])};
    double best = INFINITY;
    std::string answer;
    for (int run = 0; run < kRuns; ++run) {
        const auto start = std::chrono::steady_clock::now();
        const auto linear = LinearPlant::make(plant);
        if (!linear) {
            answer = linear.error().message;
            break;
        }
        const auto tuned = find_method("robust")->tune({plant, *linear, std::nullopt}, options, {});
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        best = std::min(best, took.count());
        char numbers[200];
        if (tuned) {
            const IdealPid& pid = tuned->controller;
            std::snprintf(numbers, sizeof numbers, "%.15g\t%.15g\t%.15g\t%.15g", pid.Kp, pid.Ti, pid.Td, pid.filter.Tf);
        }
        answer = tuned ? numbers : tuned.error().message;
    }
    std::printf("%s\t%.6g\t%s\n", fields[0].c_str(), best, answer.c_str());
}

}  // namespace
}  // namespace tunewright::bench

int main() {
    for (std::string line; std::getline(std::cin, line);) tunewright::bench::design(line);
    return 0;
}
