// What a file is read as, before anything is computed from it: its columns, its times, the lines that are passed over.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/csv_record.h"

namespace tunewright::api {

struct PreviewColumn {
    std::string heading;             ///< "" where the file has none
    std::string guess = "-";         ///< "t", "u", "y", "r", or "-" for none
    double confidence = 0;           ///< of the guess, 0 to 1: chosen or so named 1, by contents alone 0.5
    std::string unit;                ///< as the file writes it; "" if it does not
    std::string first;               ///< first cell that is not blank, as written
    std::optional<double> min, max;  ///< of its numbers
    std::vector<double> thumbnail;   ///< at most 240 numbers: least and largest of equal stretches, in turn
};

struct PreviewTime {
    double from = 0, to = 0;  ///< in `unit`
    std::string unit;
    bool assumed = false;  ///< nothing says that this is the unit
    double dt = 0;         ///< median spacing, in `unit`
    int gaps = 0;          ///< spacings of more than five times that
    int duplicates = 0;    ///< rows with the time of the row above
};

struct CsvPreview {
    std::vector<PreviewColumn> columns;
    int rows = 0;                     ///< lines of data
    std::string separator;            ///< "," ";" "tab" "|" "blanks", "pairs" for lines that name their values, or
                                      ///< "values" for a file that was made into a table (shape/shape.h)
    std::string decimal;              ///< "." or ","
    std::string encoding;             ///< encoding_of the bytes
    std::optional<PreviewTime> time;  ///< where the record can be read
    std::vector<CsvRun> runs;         ///< where the times begin again; empty: one run
    std::optional<int> run;           ///< of several, the one that is read, from 1
    std::vector<CsvSkip> skipped;     ///< the first kMaxSkips
    int skipped_lines = 0;            ///< lines of data that do not count
    std::vector<std::string> notes;   ///< as in CsvRecord
    std::vector<CsvFault> problems;   ///< why the record cannot be read yet; empty: it can
};

/// By the reader of records, and with the same options: what it answers is what read_csv_record then does. Never fails:
/// a file that is no table has problems and no columns.
CsvPreview preview_csv(std::string_view bytes, const CsvOptions& options);

}  // namespace tunewright::api
