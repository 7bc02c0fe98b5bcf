// Cells of a measurement, a controller output or a set point as numbers.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "api/csv/cell.h"

namespace tunewright::api {

/// A value that is missing.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Reads the cells of one column or tag, and counts those that are not numbers.
class ValueCells {
public:
    /// `suffix` is a unit behind the numbers, "" if it is not known yet; `words`: ON and OFF are 1 and 0.
    ValueCells(DecimalSign sign, std::string suffix, bool words)
        : sign_(sign), suffix_(std::move(suffix)), words_(words) {}

    /// NaN for a blank cell, a mark of a missing value, and a text that cannot be read. `bad`: the file marks the value
    /// as bad in another column.
    double read(std::string_view cell, bool bad);

    int bad() const { return bad_; }        ///< cells that are marked as bad, here or in another column
    int unread() const { return unread_; }  ///< texts that are neither a number nor a known mark

    /// A sentence about texts of `tag` that cannot be read; "" if there are none.
    std::string unread_note(const std::string& tag) const;

private:
    DecimalSign sign_;
    std::string suffix_;
    bool words_;
    int bad_ = 0, unread_ = 0;
    std::string first_unread_;
};

}  // namespace tunewright::api
