// The columns of a file with one line for each tag and time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/table.h"

namespace tunewright::api {

/// Columns by index. The time may be in several: `clock` has the time of day, `millis` the milliseconds.
struct LongColumns {
    std::size_t time = 0, value = 0;
    std::vector<std::size_t> tags;  ///< the parts of a tag
    std::optional<std::size_t> clock, millis;
    std::string time_heading;   ///< "" if the file has none
    bool numbers_tags = false;  ///< the tags are numbers, as under "TagIndex"
};

/// Finds the columns by their headings, or in a file without headings by their contents. Empty for another file. A
/// column of tags holds several, unless `one_tag`: the first lines of a long file may all be of one, and every column
/// that may hold a part of the tag is then given.
std::optional<LongColumns> find_long_columns(std::string_view text, const CsvLayout& layout, bool one_tag = false);

/// The tag of a line: its parts joined by a point; "" if there is none.
std::string long_tag(const std::vector<std::string_view>& cells, const LongColumns& columns);

/// The time of a line, joined from its columns.
std::string long_time(const std::vector<std::string_view>& cells, const LongColumns& columns);

/// True for the heading, in lower case, of a column of tags: "tag", "entity_id", "pointname".
bool is_tag_heading(std::string_view name);
/// The same for a column of values: "value", "wert", "reading".
bool is_value_heading(std::string_view name);

}  // namespace tunewright::api
