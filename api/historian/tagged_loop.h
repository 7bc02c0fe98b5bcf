// A loop as read from a file of many loops, in columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tunewright::api {

/// The rows of one loop, in the order of time, with at least one of y and u in each. The columns have equal lengths,
/// or are empty if the file does not have them.
struct TaggedLoop {
    std::string tag;
    std::vector<double> t;  ///< in the unit that was asked for; from the first row of the file if it has dates
    std::vector<double> y, u;          ///< NaN: missing, or of bad quality
    std::vector<double> r;             ///< set point, held from row to row; NaN before the first one
    std::vector<std::uint8_t> mode;    ///< index in mode_words, held from row to row
    std::vector<std::string> mode_words;  ///< as in the file; the first is "", unknown
    std::optional<double> epoch;          ///< seconds since 1970 at t = 0; empty: the file has no dates
    bool utc = false;                     ///< the file states the zone of its times
    int bad = 0;                          ///< values of y and u that the file marks as bad
    std::vector<std::string> notes;       ///< findings, one sentence each
    std::optional<std::string> fault;     ///< the reason why the loop cannot be read; the columns are then empty
};

}  // namespace tunewright::api
