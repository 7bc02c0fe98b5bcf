// Results of a batch as lines of text, one entry after the other: NDJSON, or CSV for spreadsheets.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tunewright::api {

/// One job of a batch in its current state. `index` is its position in the batch, from 0; the texts must outlive the
/// call that appends them.
struct ResultRow {
    std::int64_t index = 0;
    std::string_view id, name, status;  ///< "" if it has no name
    std::string_view result, error;     ///< JSON; "" if none
};

/// One line: {index, id, name, status, result or error} and \n. A job without a name has null. The JSON of result and
/// error is copied as it is.
void append_ndjson(const ResultRow& row, std::string& out);

/// The headings of the CSV with their line end: index, id, name, status, method, form, then the controller's settings
/// and its figures, warnings and error.
std::string csv_headings();

/// The headings of the CSV of a batch of checks: index, id, name, status, the loop's verdict with its figures, the
/// number of remarks on its record, and error.
std::string check_csv_headings();

/// One line for each loop of the result; one line if there is none, as in append_csv. The verdict is that of the loop
/// by itself.
void append_check_csv(const ResultRow& row, std::string& out);

/// One line for each controller of the result; one line if there is none: an error, or a job that has not ended. A
/// value that is missing, infinite or of another form is an empty cell; numbers are in full precision.
void append_csv(const ResultRow& row, std::string& out);

}  // namespace tunewright::api
