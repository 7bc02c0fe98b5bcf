// Preview of a file before anything is computed from it: its columns, its times, the skipped lines.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/csv_record.h"

namespace tunewright::api {

struct PreviewColumn {
    std::string heading;             ///< "" if the file has none
    std::string guess = "-";         ///< "t", "u", "y", "r", "mode", or "-" for none
    double confidence = 0;           ///< of the guess, 0 to 1: chosen or exactly named 1, from contents alone 0.5
    std::string unit;                ///< as in the file; "" if it has none
    std::string first;               ///< first cell that is not blank, as written
    std::optional<double> min, max;  ///< of its numbers
    std::vector<double> thumbnail;   ///< at most 240 numbers: minimum and maximum of equal stretches, in turn
};

struct PreviewTime {
    double from = 0, to = 0;  ///< in `unit`
    std::string unit;
    bool assumed = false;  ///< the unit is not stated anywhere
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
    std::optional<PreviewTime> time;  ///< if the record can be read
    std::vector<CsvRun> runs;         ///< one for each restart of the times; empty if there is one run
    std::optional<int> run;           ///< the run that is read, from 1, if there are several
    std::vector<CsvSkip> skipped;     ///< the first kMaxSkips
    int skipped_lines = 0;            ///< lines of data that are skipped
    std::vector<std::string> notes;   ///< as in CsvRecord
    std::vector<CsvFault> problems;   ///< reasons why the record cannot be read yet; empty if it can
};

/// Uses the reader of records with the same options: the preview shows what read_csv_record would read. Never fails: a
/// file that is not a table has problems and no columns.
CsvPreview preview_csv(std::string_view bytes, const CsvOptions& options);

}  // namespace tunewright::api
