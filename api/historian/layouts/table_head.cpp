#include "api/historian/layouts/table_head.h"

#include "api/historian/layouts/loop_table.h"

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
    out.file_time_unit = options.file_time_unit;
    return out;
}

}  // namespace tunewright::api
