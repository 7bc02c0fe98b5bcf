#include "api/csv/csv_writer.h"

#include <cmath>

#include "api/json/writer.h"

namespace tunewright::api {

CsvWriter& CsvWriter::cell(std::string_view written) {
    if (!first_) out_ += ',';
    first_ = false;
    out_ += written;
    return *this;
}

CsvWriter& CsvWriter::text(std::string_view value) {
    const bool formula = value.find_first_of("=+-@\t\r") == 0;
    if (!formula && value.find_first_of(",\"\r\n") == value.npos) return cell(value);
    std::string quoted = formula ? "\"'" : "\"";
    for (const char c : value) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return cell(quoted += '"');
}

CsvWriter& CsvWriter::integer(long long value) { return cell(std::to_string(value)); }

CsvWriter& CsvWriter::number(double value) { return cell(std::isfinite(value) ? full_digits(value) : std::string()); }

CsvWriter& CsvWriter::trace_number(double value) {
    return cell(std::isfinite(value) ? six_digits(value) : std::string());
}

void CsvWriter::end_line() {
    out_ += "\r\n";
    first_ = true;
}

}  // namespace tunewright::api
