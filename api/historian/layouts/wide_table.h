// Loops in the columns of a table: one line for each time.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "api/historian/layouts/loop_table.h"
#include "api/historian/layouts/table_head.h"
#include "api/historian/tags/loop_tags.h"

namespace tunewright::api {

/// Opens a table with these loops, whose tags are indices of columns. The rows have one column of times, or several if
/// tags were exported with their own: each value then belongs to the nearest time on its left.
///
/// A blank cell is a missing value. If y and u of a loop are hardly ever in the same line, the lines are those of an
/// export by changes, and the values are joined as in a file with a line for each tag (join_tags).
std::variant<std::unique_ptr<LoopTable>, Problem> open_wide_table(const TableHead& head, std::vector<LoopTags> loops,
                                                                  const LoopsOptions& options);

/// Opens a table of one loop whose columns are found by their headings and contents (find_columns).
std::variant<std::unique_ptr<LoopTable>, Problem> open_single_table(const TableHead& head, const LoopsOptions& options);

}  // namespace tunewright::api
