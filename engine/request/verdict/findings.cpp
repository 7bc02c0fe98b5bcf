#include "engine/request/verdict/findings.h"

#include <algorithm>

namespace tunewright::verdict {
namespace {

std::optional<double> above(std::optional<double> value, double floor) {
    return value && *value > floor ? value : std::nullopt;
}

}  // namespace

std::string words_of(PeakLoop loop) {
    switch (loop) {
        case PeakLoop::ideal: return "";
        case PeakLoop::on_device: return " on your controller";
        case PeakLoop::worst_plant: return " on the worst plant";
    }
    return "";
}

const Robustness& robustness_of(const TuningEntry& entry) {
    return entry.on_device ? entry.on_device->loop.robustness : entry.evaluation->robustness;
}

const Performance& performance_of(const TuningEntry& entry) {
    return entry.on_device ? entry.on_device->loop.performance : entry.evaluation->performance;
}

const Robustness& VerdictInput::robustness() const { return robustness_of(entry); }

const Performance& VerdictInput::performance() const { return performance_of(entry); }

bool VerdictInput::has_integral() const { return gains(evaluation.controller).Ki != 0; }

bool VerdictInput::warned_of(const std::string& code) const {
    return std::ranges::any_of(evaluation.warnings, [&](const Warning& warning) { return warning.code == code; });
}

RequestedLimits VerdictInput::limits() const {
    return {above(entry.Ms_limit, 1), above(entry.options.number("Mt"), 1), above(entry.options.number("Mks"), 0)};
}

std::string printed_unit(const std::string& unit) { return unit == "degC" ? "°C" : unit == "degF" ? "°F" : unit; }

std::string product_unit(const std::string& a, const std::string& b) {
    const std::string first = printed_unit(a), second = printed_unit(b);
    return first.empty() || second.empty() ? first + second : first + " " + second;
}

std::string quotient_unit(const std::string& top, const std::string& bottom) {
    const std::string over = printed_unit(top), under = printed_unit(bottom);
    if (over == under) return "";
    return (over.empty() ? "1" : over) + (under.empty() ? "" : "/" + under);
}

}  // namespace tunewright::verdict
