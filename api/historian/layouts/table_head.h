// The first lines of a table, from which its layout is found.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/columns.h"
#include "api/historian/values/value_cells.h"
#include "api/historian/values/value_quality.h"

namespace tunewright::api {

struct LoopsOptions;

struct TableHead {
    TableHead(std::string_view lines, const CsvLayout& found)
        : text(lines), layout(found), columns(profiles(lines, found)) {}

    /// The reader of a column's values.
    ValueCells value_cells(std::size_t column) const;
    /// The kind of codes in columns of quality.
    ValueQuality quality(const std::vector<std::size_t>& of) const;
    /// The heading of a column as written, or its number from 1.
    std::string name(std::size_t column) const;

    std::string_view text;
    const CsvLayout& layout;
    std::vector<ColumnProfile> columns;
};

/// Options of the readers of records for a file of loops.
CsvOptions csv_options(const LoopsOptions& options);

}  // namespace tunewright::api
