// The rows of a result's table: a controller each, in the order of the ranking.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "api/json/json.h"

namespace tunewright::api {

/// A figure of a row and its place in the entry.
struct EntryFigure {
    const char* name;
    const char* pointer;
    bool is_time;
};
inline constexpr std::array<EntryFigure, 6> kEntryFigures = {{{"Kp", "/controller/Kp", false},
                                                              {"Ti", "/controller/Ti", true},
                                                              {"Td", "/controller/Td", true},
                                                              {"Ms", "/robustness/Ms", false},
                                                              {"Mt", "/robustness/Mt", false},
                                                              {"load IAE", "/performance/load/IAE", false}}};

struct EntryRow {
    std::size_t index = 0;  ///< of the entry in the result
    std::string method, title;
    std::string level;                               ///< of the verdict's first finding; "-" if there is none
    std::array<Json, kEntryFigures.size()> figures;  ///< null where the entry has none
};

struct EntryRows {
    std::vector<EntryRow> rows;
    std::size_t without_controller = 0;  ///< entries that have no row
};

EntryRows entry_rows(const Json& result);

/// The indices of all entries: those of the ranking first.
std::vector<std::size_t> entry_order(const Json& result);

/// The entry's title, else its method, cut to the width of a column.
std::string entry_title(const Json& entry);

/// The member at a path such as "/performance/load/IAE"; null where there is none.
Json member_at(const Json& value, const char* pointer);

}  // namespace tunewright::api
