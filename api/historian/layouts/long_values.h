// Loops in a file with one line for each tag and time.
#pragma once

#include <memory>
#include <variant>

#include "api/csv/shape/long_columns.h"
#include "api/historian/layouts/loop_table.h"
#include "api/historian/layouts/table_head.h"

namespace tunewright::api {

/// Opens a file whose lines have a tag such as FIC101.PV, a time and a value, and perhaps a quality. Tags may come in
/// any order and at different times (join_tags). Tags that are no part of a loop are skipped.
std::variant<std::unique_ptr<LoopTable>, Problem> open_long_values(const TableHead& head, const LongColumns& columns,
                                                                   const LoopsOptions& options);

}  // namespace tunewright::api
