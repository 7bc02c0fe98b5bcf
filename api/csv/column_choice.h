// The columns of a file that a request names.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tunewright::api {

/// The maximum number of columns of a file; wider files are refused.
inline constexpr std::size_t kMaxColumns = 4000;

/// A heading, or the column's number from 1.
using ColumnChoice = std::variant<std::string, int>;

struct ColumnChoices {
    std::optional<ColumnChoice> t, u, y, r = {}, mode = {};
    std::vector<ColumnChoice> d = {};  ///< measured disturbances, at most kMaxFurtherInputs
};

/// The choices that are headings.
inline std::vector<std::string> chosen_names(const ColumnChoices& chosen) {
    std::vector<std::string> names;
    for (const auto* choice : {&chosen.t, &chosen.u, &chosen.y, &chosen.r, &chosen.mode})
        if (*choice && std::holds_alternative<std::string>(**choice)) names.push_back(std::get<std::string>(**choice));
    for (const ColumnChoice& choice : chosen.d)
        if (std::holds_alternative<std::string>(choice)) names.push_back(std::get<std::string>(choice));
    return names;
}

}  // namespace tunewright::api
