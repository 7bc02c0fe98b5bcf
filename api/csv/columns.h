// Which columns of a CSV file hold time, controller output and measurement.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/heading.h"
#include "api/csv/record.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// A column as its first lines of data show it.
struct ColumnProfile {
    int numbers = 0, stamps = 0, missing = 0, texts = 0;
    int dates = 0, clocks = 0;  ///< among the stamps: those without a time of day, and those without a date
    int changes = 0;            ///< from line to line
    bool rises = true;          ///< every number is above the one before
    std::string suffix;         ///< unit behind the numbers
    std::string first_text;     ///< of the texts that are neither number nor stamp nor missing
};

/// Of the first 5,000 lines.
std::vector<ColumnProfile> profiles(std::string_view text, const CsvLayout& layout);

struct FoundColumns {
    std::array<std::optional<std::size_t>, kRoleCount> at;
    std::optional<std::size_t> clock;  ///< a second column of times of day, where at[kTimeRole] holds dates alone
    std::vector<std::string> notes;
};

/// The columns as chosen; then by their headings; then, where headings do not say, by what they hold: time rises, u
/// stays on its levels while y moves. What remains open is a fault that lists the headings.
FoundColumns find_columns(const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                          const CsvOptions& options, std::vector<CsvFault>& faults);

/// The first 40 bytes in quotes.
std::string quoted(std::string_view text);

const char* role_name(std::size_t role);  ///< t, u, y

}  // namespace tunewright::api
