#include "api/csv/shape/shapes.h"

#include <algorithm>
#include <string>

#include "api/csv/cell.h"
#include "api/csv/table.h"
#include "api/csv/text.h"

namespace tunewright::api {
namespace {

struct EventLine {
    std::string_view name, time, value;  ///< name empty: the quantity that is logged continuously
};

std::optional<EventLine> event_of(std::string_view line) {
    EventLine out;
    constexpr std::size_t kLongestName = 40;
    if (const std::size_t colon = line.find(':'); colon != line.npos) {
        out.name = trimmed(line.substr(0, colon));
        line = trimmed(line.substr(colon + 1));
        if (out.name.empty() || out.name.size() > kLongestName || is_digit(out.name.front()) ||
            out.name.find_first_of(" \t,;=") != out.name.npos)
            return std::nullopt;
    }
    const std::size_t end = line.find_first_of(" \t,;");
    if (end == line.npos) return std::nullopt;
    out.time = line.substr(0, end);
    out.value = trimmed(line.substr(
        line.find_first_not_of(" \t,;", end) == line.npos ? line.size() : line.find_first_not_of(" \t,;", end)));
    double number = 0;
    if (!read_cell_number(out.time, number) || !read_cell_number(out.value, number)) return std::nullopt;
    return out;
}

}  // namespace

std::optional<ShapedText> event_lines(std::string_view text) {
    constexpr int kProbedLines = 200, kMinLinesPerOther = 10;
    std::size_t at = 0;
    int named = 0, plain = 0, other = 0;
    bool turned = false;  // a line of the other kind was found
    for (int n = 0; n < kProbedLines || (!turned && n < 100 * kProbedLines); ++n) {
        const auto line = next_line(text, at);
        if (!line) break;
        const std::string_view content = trimmed(*line);
        if (content.empty() || is_comment(content)) continue;
        const auto event = event_of(content);
        if (!event && ++other * kMinLinesPerOther > 1 + named + plain) return std::nullopt;
        if (event) ++(event->name.empty() ? plain : named);
        turned = named > 0 && plain > 0;
    }
    if (named < 2 || plain < 8) return std::nullopt;
    Pivot pivot;
    at = 0;
    for (int number = 1;; ++number) {
        const auto line = next_line(text, at);
        if (!line) break;
        const std::string_view content = trimmed(*line);
        if (content.empty() || is_comment(content)) continue;
        const auto event = event_of(content);
        if (!event || pivot.add(event->time, event->name.empty() ? "temp" : event->name, event->value, number))
            continue;
        ShapedText out;
        out.fault = "csv has lines that begin with a name, of more than " + std::to_string(Pivot::kMaxTags) +
                    " names. Leave out those that are neither u nor y.";
        return out;
    }
    ShapedText out = pivot.table("time");
    out.notes.emplace_back(
        "Lines that begin with a name contain a time and its value; the others contain a time and the measurement.");
    return out;
}

}  // namespace tunewright::api
