// Numbers inside sentences: the one formatter of the engine. Only its source file depends on {fmt}.
#pragma once

#include <string>

namespace tunewright {

/// At most `digits` significant digits (1 to 17), in the shortest form: "0.25", "1.3e-05", "1e+06".
std::string text(double x, int digits = 4);

/// A figure for people: `digits` significant digits with their zeros, no exponent from 0.001 to 99999: "1.40", "33.0",
/// "1230", "1.23e5".
std::string figure_text(double x, int digits = 3);

/// The shortest decimal that reads back as the same double: "0.1", "1e-300".
std::string exact_text(double x);

/// "1 row", "3 rows".
std::string counted(int count, const std::string& one);

}  // namespace tunewright
