#include "api/csv/shape/long_columns.h"
#include "api/csv/shape/shapes.h"

namespace tunewright::api {

std::optional<ShapedText> long_table(std::string_view text, const CsvLayout& layout) {
    const auto at = find_long_columns(text, layout);
    if (!at) return std::nullopt;
    Pivot pivot;
    CsvLines lines(text, layout);
    CsvLine line;
    while (lines.next(line)) {
        if (at->value >= line.cells.size()) continue;
        const std::string tag = long_tag(line.cells, *at);
        if (tag.empty()) continue;
        if (!pivot.add(long_time(line.cells, *at), tag, line.cells[at->value], line.number)) {
            ShapedText out;
            out.fault = "csv has one line for each tag and time, of more than " + std::to_string(Pivot::kMaxTags) +
                        " tags. Export only those of u, y and the set point.";
            return out;
        }
    }
    if (pivot.tags().size() < 2) return std::nullopt;
    ShapedText out = pivot.table(at->time_heading.empty() ? "time" : at->time_heading);
    out.notes.push_back("The file has one line for each tag and time; " + std::to_string(pivot.tags().size()) +
                        " tags became columns. u is constant until its next value; y is used at its own times.");
    return out;
}

}  // namespace tunewright::api
