// A file that holds one tag, a part of a loop: time and value.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "api/historian/layouts/loop_table.h"
#include "api/historian/layouts/table_head.h"

namespace tunewright::api {

/// The columns of such a file, and its tag.
struct TagColumns {
    std::string tag;
    std::size_t time = 0, value = 0;
    std::optional<std::size_t> clock = {};  ///< the time of day, if `time` holds dates only
    std::optional<std::size_t> quality = {};
};

/// Finds them: a time, one column more, and perhaps its quality. The tag is the heading of the value, or else the name
/// of the file; it must name a loop and its part, as "FIC101.PV". Empty for another file.
std::optional<TagColumns> find_tag_columns(const TableHead& head, const LoopsOptions& options);

/// Its only loop is a part of one (TaggedLoop::only_tag).
std::variant<std::unique_ptr<LoopTable>, Problem> open_tag_table(const TableHead& head, const TagColumns& columns,
                                                                 const LoopsOptions& options);

}  // namespace tunewright::api
