// The layout of a file with a line for each tag and time, if its first lines do not show it.
#pragma once

#include <optional>
#include <string_view>

#include "api/csv/shape/long_columns.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// Files in the order of their tags begin with thousands of lines of one tag, which may all be words such as AUTO or a
/// description. The headings then show the layout: columns of tags, values and times. Moves the first line of data to
/// the one below them. `one_tag`: the file may hold one tag; its headings name a value and a time alone, or are
/// missing.
void begin_below_tag_headings(std::string_view head, bool one_tag, CsvLayout& layout);

/// The columns of such a file; empty for another one. Of several columns of tags those are taken that name a loop and
/// its part: "FIC101.PV" alone next to "Feed flow", or "FIC101" with "PV".
std::optional<LongColumns> find_tag_lines(std::string_view head, const CsvLayout& layout);

}  // namespace tunewright::api
