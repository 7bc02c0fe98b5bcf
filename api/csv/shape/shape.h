// A file as the reader sees it: its text, made into a table where it is none, and its layout.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/csv/csv_record.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// The bytes of a file, opened. What it was given must outlive it; it is neither copied nor moved, because its texts
/// refer to it.
class CsvSource {
public:
    CsvSource(std::string_view bytes, const ColumnChoices& chosen);
    CsvSource(const CsvSource&) = delete;
    CsvSource& operator=(const CsvSource&) = delete;

    std::string_view text() const { return text_; }       ///< UTF-8, of the table
    std::string_view file_text() const { return file_; }  ///< UTF-8, of the file
    const CsvLayout& layout() const { return layout_; }
    const std::vector<std::string>& notes() const { return notes_; }
    const std::string& fault() const { return fault_; }        ///< "" where the file can be read as a table
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
