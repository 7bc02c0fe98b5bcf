// The formula of a tuning method as Presentation MathML.
#pragma once

#include <string>
#include <string_view>

#include "engine/expected.h"

namespace tunewright::api {

/// One `math` element without white space around it: a table with a row for each line of the text. A row's first cell
/// is the line's label (empty where it has none), the others are its formulas; words are in `mtext`. The only
/// attributes are those of `math` and stretchy="false" of brackets, the only entities &lt; and &gt;. Errors: as
/// notation::read_formula.
Expected<std::string> method_mathml(std::string_view formula);

}  // namespace tunewright::api
