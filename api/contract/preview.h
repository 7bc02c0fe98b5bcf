// The preview of a file of a recorded test: request with the file and the choices, answer with columns, times and
// skipped lines.
#pragma once

#include <optional>
#include <string>

#include "api/csv/preview.h"
#include "api/describe/description.h"

namespace tunewright::api {

struct PreviewRequest {
    std::optional<std::string> csv;               ///< set in every request that was read without a fault
    std::optional<ColumnChoices> columns;         ///< set if columns are chosen
    std::optional<double> dt;                     ///< sampling time in seconds, for a file without times
    std::optional<std::string> time_unit;         ///< of the file's times
    std::optional<std::array<double, 2>> u_step;  ///< for a file without u
    std::optional<int> run;                       ///< one of several runs, from 1
};

/// Reading accepts any text: the reasons why it is not a record are part of the answer.
const Description<PreviewRequest>& preview_request_contract();

/// The interpretation of a file as a record with the same members, and its problems, whose pointers are members of that
/// record. The times are in seconds.
const Description<CsvPreview>& preview_answer_contract();

/// The options for reading a record with the same members, with times in seconds.
CsvOptions csv_options(const PreviewRequest& request);

}  // namespace tunewright::api
