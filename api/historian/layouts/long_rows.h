// Loops in a file with one line for each loop and time: "time,tag,pv,sp,op,mode".
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "api/historian/layouts/loop_table.h"
#include "api/historian/layouts/table_head.h"
#include "api/historian/tags/loop_tags.h"

namespace tunewright::api {

/// The columns of such a file. The tags are names of loops.
struct LoopRowColumns {
    std::size_t tag = 0;
    LoopTags parts;  ///< columns of y, u, r and mode, with those of quality
};

/// Finds them by their headings: a column of tags, and one each of y and u that name no loop. Empty for another file.
std::optional<LoopRowColumns> find_loop_rows(const TableHead& head);

std::variant<std::unique_ptr<LoopTable>, Problem> open_long_rows(const TableHead& head, const LoopRowColumns& columns,
                                                                 const LoopsOptions& options);

}  // namespace tunewright::api
