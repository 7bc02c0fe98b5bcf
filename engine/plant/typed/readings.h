// Numbers, lists, roots and units of time as they are typed.
#pragma once

#include <complex>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// Of "ms", "min", "hours", ...; not of "s", which is the Laplace variable in a formula.
std::optional<double> seconds_of_unit(std::string_view name);

/// `value` given in a unit of `unit` seconds, in the request's unit of `own` seconds.
double in_own_time(double value, double unit, double own);

/// What stands between the numbers of a list.
enum class Commas {
    separate,  ///< inside brackets of matrix programs, where 1,2 are two numbers
    decimal,   ///< where at most one number is expected: 2,5 is 2.5
    refused,   ///< a list of numbers without brackets, where 1,2 may be either
};

/// The number at the cursor, which is one, its decimal comma taken as `commas` says; the cursor stands behind it.
double read_number(Cursor& cursor, Commas commas);

/// The same with a sign before it, and with / or * and another number behind it, as in -1/3.
double read_value(Cursor& cursor, Commas commas);

/// Numbers or complex roots up to what cannot be one: -1, -3+4i, -3±4j for a pair. A sign after a blank and before none
/// begins a new one, as matrix programs read it. With `commas` separate the list stands in [ ] or is one number.
std::vector<std::complex<double>> read_roots(Cursor& cursor, Commas commas);
std::vector<double> read_coefficients(Cursor& cursor);

}  // namespace tunewright::typed
