// Headings that identify u and y only as a pair: letters of a textbook, a controller's own words, parts of a data set.
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
    std::string why_u = {}, why_y = {};  ///< " (...)", added to the role
    std::string note = {};               ///< a sentence about the pair; "" for none
};

/// w, x and y: set point, measurement and controller output in German textbooks and blocks.
std::optional<NamedPair> fold_umlauts(const ColumnFacts& facts);

/// "uEst" and "yEst" next to "uVal" and "yVal": the part for identification, not the one for validation.
std::optional<NamedPair> data_set(const ColumnFacts& facts);

/// "input" next to "output": a controller's input is the plant's output. A set point shows that these are the
/// controller's words; otherwise u is the column that stays on its levels. A sentence if neither shows it. `free` is
/// true for columns that may be u or y.
std::variant<std::monostate, NamedPair, std::string> input_with_output(const ColumnFacts& facts,
                                                                       const std::function<bool(std::size_t)>& free);

}  // namespace tunewright::api
