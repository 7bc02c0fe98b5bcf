#include "api/historian/layouts/loop_table.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "api/csv/cell.h"
#include "api/csv/record_notes.h"
#include "api/csv/text.h"
#include "api/historian/layouts/long_rows.h"
#include "api/historian/layouts/long_values.h"
#include "api/historian/layouts/table_head.h"
#include "api/historian/layouts/tag_table.h"
#include "api/historian/layouts/wide_table.h"
#include "api/historian/tags/loop_tags.h"
#include "api/historian/tags/tag_lines.h"

namespace tunewright::api {

Problem unreadable_loops(std::string detail) {
    Problem problem{422, "invalid-request", "The file of loops cannot be read", detail, {}, {}};
    problem.errors.push_back({"", std::move(detail)});
    return problem;
}

bool is_ending_of_records(std::string_view ending) {
    static constexpr std::string_view kEndings[] = {".csv", ".tsv", ".txt", ".dat"};
    return std::ranges::find(kEndings, lower_case(ending)) != std::end(kEndings);
}

void LoopsOptions::set_file(const std::string& file) {
    name = file.substr(file.find_last_of('/') + 1);
    named_by_file = true;
    if (const std::size_t point = name.rfind('.'); point != name.npos && point > 0)
        if (is_ending_of_records(std::string_view(name).substr(point))) name.resize(point);
}

std::variant<std::unique_ptr<LoopTable>, Problem> open_table(std::string_view head, const CsvLayout& layout,
                                                             const LoopsOptions& options,
                                                             std::vector<std::string>& notes) {
    if (layout.width > kMaxColumns)
        return unreadable_loops("The file has " + std::to_string(layout.width) + " columns; at most " +
                                std::to_string(kMaxColumns) + " are read. Send it in parts, with fewer loops in each.");
    if (layout.data_line == 0) {
        const std::string_view text = trimmed(head);
        return unreadable_loops(no_data_sentence(layout, text.substr(0, text.find_first_of("\r\n"))));
    }
    if (layout.pairs)
        return unreadable_loops(
            "The lines name their values, as in a log of one loop. Export a table with a column for "
            "each tag, or a line for each tag and time.");
    const TableHead first(head, layout);
    GroupedTags groups = group_tags(layout.headings);
    const auto note_partial = [&] {
        if (auto note = partial_note(groups.partial); !note.empty()) notes.push_back(std::move(note));
    };
    if (groups.loops.size() > 1) note_partial();
    if (groups.loops.size() > 1) return open_wide_table(first, std::move(groups.loops), options);
    if (const auto columns = find_loop_rows(first)) return open_long_rows(first, *columns, options);
    if (const auto columns = find_tag_lines(head, layout)) return open_long_values(first, *columns, options);
    if (options.named_by_file && groups.loops.empty())
        if (const auto columns = find_tag_columns(first, options)) return open_tag_table(first, *columns, options);
    if (groups.loops.empty() || groups.loops.front().name.empty()) return open_single_table(first, options);
    note_partial();
    return open_wide_table(first, std::move(groups.loops), options);
}

}  // namespace tunewright::api
