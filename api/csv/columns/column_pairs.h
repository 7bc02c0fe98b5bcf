// Headings that say u and y only together: letters of a textbook, a controller's own words, parts of a data set.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "api/csv/columns/column_facts.h"

namespace tunewright::api {

struct NamedPair {
    std::size_t u = 0, y = 0;
    std::string why_u = {}, why_y = {};  ///< " (...)", behind what they are read as
    std::string note = {};               ///< a sentence beside it; "" for none
};

/// w, x and y: set point, measurement and controller output in German textbooks and blocks.
std::optional<NamedPair> fold_umlauts(const ColumnFacts& facts);

/// "uEst" and "yEst" beside "uVal" and "yVal": the part to identify with, not the one to check with.
std::optional<NamedPair> data_set(const ColumnFacts& facts);

/// "input" beside "output": what a controller calls its input is the plant's output. A set point shows that these
/// are the controller's words; else u is the one that stays on its levels. A sentence where neither shows it. `free`
/// says whether a column may be u or y.
std::variant<std::monostate, NamedPair, std::string> input_beside_output(const ColumnFacts& facts,
                                                                         const std::function<bool(std::size_t)>& free);

}  // namespace tunewright::api
