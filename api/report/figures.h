// Numbers and tables of the report. A figure carries the place of its value in the result, so that the printed value
// can be compared with the computed one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json.h"
#include "api/report/html.h"
#include "api/report/report_input.h"

namespace tunewright::api {

/// The number with this number of significant digits and a true minus sign: "1.385".
std::string number_text(double value, int digits = 4);

/// A number as <span data-at="/controllers/0/...">1.385</span>; a dash and its reason if it is null.
Html figure(const JsonLocation& place, int digits = 4);

/// The reason next to a null; "" if there is none.
std::string why_null(const JsonLocation& place);

using Row = std::vector<Html>;

/// True if any of these objects has a member of that name.
bool any_has(const std::vector<JsonLocation>& places, const std::string& name);

/// The value with its error in two digits, "40 +- 0.30"; the value alone if the error is below a millionth of it.
std::string uncertain_text(double value, double standard_error);
/// True if a standard error is too small next to its value to be reported.
bool negligible(double standard_error, double value);

/// A model's `grade` and `grade_reason` as a sentence; "" for an unknown grade.
std::string grade_words(std::string_view grade, std::string_view reason);

/// A table; the first cell of each row names it.
Html table(const char* caption, const Row& heads, const std::vector<Row>& rows);
Html list(const std::vector<Html>& items);
Html section(const char* title, const Html& inside);

/// A quotient of units: "degC/%", "1/s"; "" if a part is not known.
std::string unit_quotient(const std::string& above, const std::string& below);
/// The name with its unit: "Ti (s)".
std::string with_unit(const std::string& name, const std::string& unit);

}  // namespace tunewright::api
