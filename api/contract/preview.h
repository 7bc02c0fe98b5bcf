// What a file of a recorded test is read as: a file, and what was chosen of it, in; columns, times and passed lines
// out.
#pragma once

#include <optional>
#include <string>

#include "api/csv/preview.h"
#include "api/describe/description.h"

namespace tunewright::api {

struct PreviewRequest {
    std::optional<std::string> csv;               ///< set in every request that was read without a fault
    std::optional<ColumnChoices> columns;         ///< where they are chosen
    std::optional<double> dt;                     ///< sampling time in seconds, of a file without times
    std::optional<std::string> time_unit;         ///< of the file's times
    std::optional<std::array<double, 2>> u_step;  ///< of a file without u
    std::optional<int> run;                       ///< of several, from 1
};

/// Reading takes any text: what keeps it from being a record is part of the answer.
const Description<PreviewRequest>& preview_request_contract();

/// What a record of the same members would be read as, and its problems, whose pointers are members of that record.
/// The times are in seconds.
const Description<CsvPreview>& preview_answer_contract();

/// The options by which a record of the same members is read, with times in seconds.
CsvOptions csv_options(const PreviewRequest& request);

}  // namespace tunewright::api
