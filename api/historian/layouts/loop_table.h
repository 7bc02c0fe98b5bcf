// A file of many loops, whose layout is known from its first lines, row by row.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/csv/table.h"
#include "api/historian/tagged_loop.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// The largest number of values and times that are kept of a file: a day of 500 loops at 10 s has 13 million values.
inline constexpr std::size_t kMaxLoopNumbers = 30'000'000;

struct LoopsOptions {
    std::string time_unit = "s";      ///< of the times of the loops
    bool time_unit_given = false;     ///< also that of times whose unit the file does not state
    std::string file_time_unit = {};  ///< of the times of the file, which overrides the file; "": the file's own
    std::string name = "Loop 1";      ///< tag of the loop in a file whose headings name none, such as "t,sp,pv,op"
    bool named_by_file = false;       ///< several files may be parts of one loop; `name` is that of the file
    std::size_t max_numbers = kMaxLoopNumbers;

    /// Takes the name of the file, without folders and without an ending such as .csv.
    void set_file(const std::string& file);
};

/// True for the ending of a file that may hold records: ".csv", ".tsv", ".txt", ".dat".
bool is_ending_of_records(std::string_view ending);

class LoopTable {
public:
    virtual ~LoopTable() = default;

    /// Reads the cells of the next line of data; `line` is its number in the file.
    virtual void row(int line, const std::vector<std::string_view>& cells) = 0;
    /// After the last row: gives the loops one after the other and frees their memory. False after the last one.
    virtual bool next(TaggedLoop& loop) = 0;

    /// Values and times that are kept.
    virtual std::size_t numbers() const = 0;
    /// Rows with a time.
    virtual std::size_t rows() const = 0;
    /// Findings about the file; after the last row.
    virtual std::vector<std::string> notes() = 0;
    /// The reason why no further row can be read; "" if there is none.
    virtual std::string fault() const { return {}; }
};

/// Opens the table that the first lines of a file show, in this order:
///
/// 1. several loops in columns (wide_table.h);
/// 2. a line for each loop and time, with its values in columns (long_rows.h);
/// 3. a line for each tag and time (long_values.h);
/// 4. one tag, if the file is one of several (tag_table.h);
/// 5. one loop in columns.
///
/// 422 with the reason if the file has none of these layouts. Adds its findings to `notes`. `head` and `layout` need
/// not outlive the table.
std::variant<std::unique_ptr<LoopTable>, Problem> open_table(std::string_view head, const CsvLayout& layout,
                                                             const LoopsOptions& options,
                                                             std::vector<std::string>& notes);

/// 422 for a file of loops that cannot be read.
Problem unreadable_loops(std::string detail);

}  // namespace tunewright::api
