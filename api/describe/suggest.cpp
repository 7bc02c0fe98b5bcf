#include "api/describe/suggest.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace tunewright::api {
namespace {

std::string folded(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c != '_' && c != '-' && c != ' ') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return out;
}

// Edit distance in which swapping neighbours is one step (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = std::exchange(last, row);
    }
    return last[b.size()];
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 30> kSynonyms = {{{"deadtime", "L"},
                                                                                      {"delay", "L"},
                                                                                      {"theta", "L"},
                                                                                      {"timedelay", "L"},
                                                                                      {"gain", "K"},
                                                                                      {"tau", "T"},
                                                                                      {"timeconstant", "T"},
                                                                                      {"tau1", "T1"},
                                                                                      {"tau2", "T2"},
                                                                                      {"numerator", "num"},
                                                                                      {"denominator", "den"},
                                                                                      {"z", "zeros"},
                                                                                      {"p", "poles"},
                                                                                      {"k", "Kp"},
                                                                                      {"kc", "Kp"},
                                                                                      {"gain", "Kp"},
                                                                                      {"p", "Kp"},
                                                                                      {"i", "Ki"},
                                                                                      {"d", "Kd"},
                                                                                      {"beta", "b"},
                                                                                      {"gamma", "c"},
                                                                                      {"process", "plant"},
                                                                                      {"model", "plant"},
                                                                                      {"methods", "tune"},
                                                                                      {"controller", "controllers"},
                                                                                      {"controllers", "baseline"},
                                                                                      {"data", "record"},
                                                                                      {"time", "t"},
                                                                                      {"timeout", "timeout_s"},
                                                                                      {"damping", "zeta"}}};

}  // namespace

std::string nearest(std::string_view name, std::span<const std::string> candidates) {
    const std::string wanted = folded(name);
    constexpr std::size_t kLongest = 40;
    if (wanted.empty() || wanted.size() > kLongest) return {};
    for (const std::string& candidate : candidates) {
        if (folded(candidate) == wanted) return candidate;
    }
    for (const auto& [synonym, meant] : kSynonyms) {
        if (synonym == wanted && std::find(candidates.begin(), candidates.end(), meant) != candidates.end())
            return std::string(meant);
    }
    std::string best;
    std::size_t min = wanted.size() <= 2 ? 0 : wanted.size() <= 4 ? 1 : 2;
    for (const std::string& candidate : candidates) {
        const std::size_t steps = distance(wanted, folded(candidate));
        if (steps < min + (best.empty() ? 1 : 0)) {
            min = steps;
            best = candidate;
        }
    }
    return best;
}

std::string listed(std::span<const std::string> names, std::string_view conjunction) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) out += i + 1 == names.size() ? " " + std::string(conjunction) + " " : ", ";
        out += names[i];
    }
    return out;
}

}  // namespace tunewright::api
