#include "api/historian/table_head.h"

#include "api/historian/loop_table.h"

namespace tunewright::api {

ValueCells TableHead::value_cells(std::size_t column) const {
    const ColumnProfile& held = columns[column];
    return {layout.sign, held.suffix, held.switches > held.numbers};
}

ValueQuality TableHead::quality(const std::vector<std::size_t>& of) const {
    ValueQuality out;
    if (of.empty()) return out;
    CsvLines lines(text, layout);
    CsvLine line;
    while (lines.next(line))
        for (const std::size_t column : of)
            if (column < line.cells.size()) out.look_at(line.cells[column]);
    return out;
}

std::string TableHead::name(std::size_t column) const {
    const bool named = column < layout.headings.size() && !layout.headings[column].empty();
    return named ? layout.headings[column] : "column " + std::to_string(column + 1);
}

CsvOptions csv_options(const LoopsOptions& options) {
    CsvOptions out;
    out.time_unit = options.time_unit;
    out.time_unit_given = options.time_unit_given;
    return out;
}

std::variant<TagClock, std::string> open_clock(const TableHead& head, std::size_t column,
                                               std::optional<std::size_t> clock, const LoopsOptions& options) {
    DetectedColumns columns;
    columns.at[kTimeRole] = column;
    columns.clock = clock;
    std::vector<CsvFault> faults;
    const CsvOptions csv = csv_options(options);
    TimeColumn times(head.text, head.layout, columns, head.columns[column], csv, faults);
    if (!faults.empty()) return faults.front().message;
    return TagClock(std::move(times), seconds_per(options.time_unit).value_or(0));
}

}  // namespace tunewright::api
