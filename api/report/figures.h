// Numbers and tables of the report. A figure carries the place of its value in the result, so that what is
// printed can be compared with what was computed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json.h"
#include "api/report/html.h"
#include "api/report/report_input.h"

namespace tunewright::api {

/// "1.385": so many significant digits, a true minus sign.
std::string number_text(double value, int digits = 4);
/// Of a tick: as short as it is exact.
std::string tick_text(double value);

/// A number as <span data-at="/controllers/0/...">1.385</span>; a dash and its reason where it is null.
Html figure(const JsonLocation& place, int digits = 4);

using Row = std::vector<Html>;

/// True if any of these objects has a member of that name.
bool any_has(const std::vector<JsonLocation>& places, const std::string& name);

/// "40 +- 0.30", the error with two digits; the value alone where the error is below a millionth of it.
std::string uncertain_text(double value, double standard_error);
/// True if a standard error is too small next to its value to be reported.
bool negligible(double standard_error, double value);

/// A model's `grade` and `grade_reason` as a sentence; "" for a grade that is not known.
std::string grade_words(std::string_view grade, std::string_view reason);

/// The first cell of each row names it.
Html table(const char* caption, const Row& heads, const std::vector<Row>& rows);
Html list(const std::vector<Html>& items);
Html section(const char* title, const Html& inside);

/// "degC/%", "1/s"; "" where a part is not known.
std::string unit_quotient(const std::string& above, const std::string& below);
/// "Ti (s)"
std::string with_unit(const std::string& name, const std::string& unit);

}  // namespace tunewright::api
