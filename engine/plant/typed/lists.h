// Reads lists and matrices of numbers as programs write them, and the values that statements before have named.
#pragma once

#include <complex>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/plant/plant.h"
#include "engine/plant/typed/formula.h"
#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// Rows of numbers; a number alone is one row.
using Matrix = std::vector<std::vector<std::complex<double>>>;

/// The value of a name: one of the members.
struct NamedValue {
    std::optional<Formula> formula = {};
    std::optional<Matrix> matrix = {};
    std::optional<StateSpace> states = {};
};
using Names = std::map<std::string, NamedValue, std::less<>>;

/// True if a list or a matrix begins at the cursor: a bracket [ or {, conv( or array(, or the name of a list.
bool at_list(const Cursor& cursor, const Names& names);

/// A matrix, a list or a number, up to the first word that does not belong to it:
///
///   matrix:   [ row { ";" row } ] with { } as well; also [[1, 2], [3, 4]]; a ' after it transposes
///             | conv(list, list) | array(matrix) | name | sum
///   row:      sum { [","] sum }; in brackets a sign after a blank and before none begins a new number, as in MATLAB
///   sum:      product { ("+" | "-" | "±") product }        product: signed { ("*" | "/") signed }
///   signed:   ["+" | "-"] number [i | j | im] | i | pi | Inf | name | "(" sum ")", each with "^" whole number
Matrix read_matrix(Cursor& cursor, const Names& names);

/// The transposed matrix; the rows have equal lengths.
Matrix transposed(const Matrix& matrix);

}  // namespace tunewright::typed
