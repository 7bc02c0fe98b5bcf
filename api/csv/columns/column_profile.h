// Contents of the columns of a CSV file: numbers, times, words; whether they rise, stay or move.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/table.h"

namespace tunewright::api {

/// Profile of a column from its first lines of data.
struct ColumnProfile {
    int numbers = 0, stamps = 0, missing = 0, texts = 0;
    int dates = 0, clocks = 0;              ///< of the stamps: those without a time of day, and those without a date
    int switches = 0;                       ///< words such as ON and OFF; not among the texts
    int modes = 0;                          ///< texts that are modes of a loop (loop_mode.h)
    int changes = 0;                        ///< of the numbers and words, from line to line
    int falls = 0;                          ///< numbers below the previous one
    int text_changes = 0;                   ///< of the texts, from line to line
    bool rises = true;                      ///< every number is above the previous one
    double first = 0;                       ///< first number
    double min_step = 0, largest_step = 0;  ///< of numbers that rise
    std::string suffix;                     ///< unit behind the numbers
    std::string first_text;                 ///< first text that is not a number, a stamp or the mark of a missing value
};

/// Cells of another kind than the rest of their column are damaged if they are at most one in kDamagedShare.
constexpr int kDamagedShare = 50;

constexpr int kProfiledLines = 5000;

/// Profiles of the columns from the first kProfiledLines lines.
std::vector<ColumnProfile> profiles(std::string_view text, const CsvLayout& layout);

/// True if the difference of two columns of times is not constant. Local time and UTC differ by a constant.
bool run_apart(std::string_view text, const CsvLayout& layout, std::size_t one, std::size_t other);

}  // namespace tunewright::api
