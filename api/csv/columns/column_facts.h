// Facts about a file's columns before any is chosen: from headings, from contents, and from both.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/column_profile.h"
#include "api/csv/columns/heading.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// `text` and `layout` must outlive it. Columns are indices from 0.
class ColumnFacts {
public:
    ColumnFacts(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles);

    std::size_t size() const { return profiles_.size(); }
    std::string_view text() const { return text_; }
    const CsvLayout& layout() const { return layout_; }
    const Heading& heading(std::size_t column) const { return headings_[column]; }
    const ColumnProfile& profile(std::size_t column) const { return profiles_[column]; }

    bool holds_numbers(std::size_t column) const;
    bool switches(std::size_t column) const;        ///< between words such as ON and OFF
    bool is_index(std::size_t column) const;        ///< numbers the rows, according to its heading
    bool mostly_one_way(std::size_t column) const;  ///< as times do, also from the newest to the oldest
    bool may_be_time(std::size_t column) const;     ///< a column named t or T may be a temperature
    bool is_clock(std::size_t column) const;        ///< holds only times

    /// True if `a` stays on its levels while `b` moves, as u does while y moves.
    bool held(std::size_t a, std::size_t b) const;

    std::string shown(std::size_t column) const;  ///< its heading in quotes, or its number from 1
    std::string shown(const std::vector<std::size_t>& columns) const;
    std::string headings_listed() const;

private:
    std::string_view text_;
    const CsvLayout& layout_;
    const std::vector<ColumnProfile>& profiles_;
    std::vector<Heading> headings_;
};

/// The first 40 bytes, in quotes.
std::string in_quotes(std::string_view text);

}  // namespace tunewright::api
