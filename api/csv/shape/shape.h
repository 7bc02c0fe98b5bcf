// An opened file: its text, converted to a table if necessary, and its layout.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/csv/csv_record.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// The bytes of a file, opened. The bytes must outlive it; it can be neither copied nor moved, because its texts refer
/// to it.
class CsvSource {
public:
    CsvSource(std::string_view bytes, const ColumnChoices& chosen);
    CsvSource(const CsvSource&) = delete;
    CsvSource& operator=(const CsvSource&) = delete;

    std::string_view text() const { return text_; }       ///< UTF-8, of the table
    std::string_view file_text() const { return file_; }  ///< UTF-8, of the file
    const CsvLayout& layout() const { return layout_; }
    const std::vector<std::string>& notes() const { return notes_; }
    const std::string& fault() const { return fault_; }        ///< "" if the file can be read as a table
    const std::string& fault_at() const { return fault_at_; }  ///< as CsvFault::where

private:
    void take(struct ShapedText shaped);
    void refuse_width();

    std::string utf8_, shaped_;
    std::string_view file_, text_;
    CsvLayout layout_;
    std::vector<std::string> notes_;
    std::string fault_, fault_at_ = "csv";
};

}  // namespace tunewright::api
