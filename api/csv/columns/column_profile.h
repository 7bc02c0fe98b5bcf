// What the columns of a CSV file hold: numbers, times, words; whether they rise, stay or move.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/table.h"

namespace tunewright::api {

/// A column as its first lines of data show it.
struct ColumnProfile {
    int numbers = 0, stamps = 0, missing = 0, texts = 0;
    int dates = 0, clocks = 0;              ///< among the stamps: those without a time of day, and those without a date
    int switches = 0;                       ///< words such as ON and OFF; not among the texts
    int changes = 0;                        ///< of the numbers and words, from line to line
    int falls = 0;                          ///< numbers below the one before
    int text_changes = 0;                   ///< of the texts, from line to line
    bool rises = true;                      ///< every number is above the one before
    double first = 0;                       ///< number
    double min_step = 0, largest_step = 0;  ///< of numbers that rise
    std::string suffix;                     ///< unit behind the numbers
    std::string first_text;                 ///< of the texts that are neither number nor stamp nor missing
};

/// Cells of another kind than their column's are damaged where they are at most one in so many.
constexpr int kDamagedShare = 50;

constexpr int kProfiledLines = 5000;

/// Of the first kProfiledLines lines.
std::vector<ColumnProfile> profiles(std::string_view text, const CsvLayout& layout);

/// Whether two columns of times differ by other than a constant: local time and UTC do not.
bool run_apart(std::string_view text, const CsvLayout& layout, std::size_t one, std::size_t other);

}  // namespace tunewright::api
