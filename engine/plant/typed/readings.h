// Reads numbers, lists, roots and units of time as they are typed.
#pragma once

#include <complex>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// Seconds of "ms", "min", "hours", ...; not of "s", which is the Laplace variable in a formula.
std::optional<double> seconds_of_unit(std::string_view name);

/// `value` in a unit of `unit` seconds, converted to the request's unit of `own` seconds.
double in_own_time(double value, double unit, double own);

/// The role of a comma between digits.
enum class Commas {
    separate,  ///< inside brackets of matrix programs: 1,2 is two numbers
    decimal,   ///< if at most one number is expected: 2,5 is 2.5
    refused,   ///< in a list of numbers without brackets: 1,2 may be either
};

/// Reads the number at the cursor (there must be one) with the decimal comma of `commas`; the cursor is then after it.
double read_number(Cursor& cursor, Commas commas);

/// The same with an optional sign, and with / or * and another number, as in -1/3.
double read_value(Cursor& cursor, Commas commas);

/// Numbers or complex roots up to what cannot be one: -1, -3+4i, -3±4j for a pair. A sign that follows a blank and is
/// not followed by one begins a new root, as in matrix programs. In [ ] a comma separates two of them; without brackets
/// 1,2 is refused.
std::vector<std::complex<double>> read_roots(Cursor& cursor);

}  // namespace tunewright::typed
