// The words with which loggers, historians and people name time, controller output, measurement and set point.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/heading.h"

namespace tunewright::api {

template <std::size_t N>
bool is_one_of(std::string_view word, const std::string_view (&list)[N]) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

/// Position of a whole name in the role's list, in the order of preference from 0.
std::optional<int> place(std::string_view name, ColumnRole role);

/// The position of one word of a name, with or without digits behind it: "pv1" is "pv". Empty for a single letter, and
/// for words that name a role only on their own, such as "motor".
std::optional<int> word_place(std::string_view word, ColumnRole role);

/// A heading split into its words, lower case.
std::vector<std::string> words(std::string_view text);

}  // namespace tunewright::api
