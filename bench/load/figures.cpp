#include "bench/load/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace tunewright::load {
namespace {

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, std::abs(value) >= 1000 ? "%.0f" : "%.4g", value);
    return text;
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out.push_back('\\');
        out.push_back(c);
    }
    return out + "\"";
}

}  // namespace

void AnswerLog::add(const Answer& answer, bool expected) {
    seconds_.push_back(answer.seconds);
    sorted_ = false;
    statuses_[answer.status]++;
    if (!expected) errors_++;
}

double AnswerLog::percentile_ms(double share) const {
    if (seconds_.empty()) return 0;
    if (!sorted_) std::sort(seconds_.begin(), seconds_.end());
    sorted_ = true;
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(seconds_.size())));
    return 1e3 * seconds_[std::clamp<std::size_t>(rank, 1, seconds_.size()) - 1];
}

std::string AnswerLog::statuses() const {
    std::string out;
    for (const auto& [status, count] : statuses_) {
        if (!out.empty()) out += ", ";
        out += (status == 0 ? "lost" : std::to_string(status)) + ": " + std::to_string(count);
    }
    return out;
}

void Figures::add(const std::string& name, double value, const std::string& unit) {
    items_.push_back({name, number(value), unit, true});
}

void Figures::add(const std::string& name, const std::string& text) { items_.push_back({name, text, "", false}); }

void Figures::add(const AnswerLog& answers, double duration_s) {
    add("rate", static_cast<double>(answers.count() - answers.errors()) / duration_s, "/s");
    add("p50", answers.percentile_ms(0.50), "ms");
    add("p95", answers.percentile_ms(0.95), "ms");
    add("p99", answers.percentile_ms(0.99), "ms");
    add("longest", answers.longest_ms(), "ms");
    add("errors", static_cast<double>(answers.errors()));
    add("statuses", answers.statuses());
}

std::string Figures::text() const {
    std::string out;
    for (const Item& item : items_) {
        char line[200];
        std::snprintf(line, sizeof line, "  %-16s %s%s%s\n", item.name.c_str(), item.text.c_str(),
                      item.unit.empty() ? "" : " ", item.unit.c_str());
        out += line;
    }
    return out;
}

std::string Figures::json() const {
    std::string out = "{";
    for (const Item& item : items_) {
        if (out.size() > 1) out += ", ";
        out += quoted(item.name) + ": " + (item.number ? item.text : quoted(item.text));
    }
    return out + "}";
}

double Figures::value(const std::string& name) const {
    const auto found = std::find_if(items_.begin(), items_.end(), [&](const Item& item) { return item.name == name; });
    return found == items_.end() ? 0 : std::strtod(found->text.c_str(), nullptr);
}

}  // namespace tunewright::load
