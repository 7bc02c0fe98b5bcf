// CSV text that spreadsheets and programs read in the same way (RFC 4180).
#pragma once

#include <string>
#include <string_view>

namespace tunewright::api {

/// Cells are separated by commas, quoted if necessary, and \r\n ends a line. A text that a spreadsheet would read as a
/// formula (it begins with = + - @, a tab or \r) gets an apostrophe in front:
///
///     CsvWriter out;
///     out.text("Kp, Ti").text("=1").number(0.25).end_line();  // "Kp, Ti","'=1",0.25
class CsvWriter {
public:
    CsvWriter& text(std::string_view value);  ///< UTF-8
    CsvWriter& integer(long long value);
    CsvWriter& number(double value);        ///< shortest text that reads back as the same double; not finite: empty
    CsvWriter& trace_number(double value);  ///< six significant digits, as in traces
    CsvWriter& empty() { return cell({}); }
    void end_line();

    std::string take() { return std::move(out_); }

private:
    CsvWriter& cell(std::string_view written);

    std::string out_;
    bool first_ = true;
};

}  // namespace tunewright::api
