// application/problem+json (RFC 9457): the answer to a request that is refused or fails.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/identification/record/record.h"

namespace tunewright::api {

struct FieldError {
    std::string pointer;  ///< JSON Pointer into the request, e.g. "/plant/L"
    std::string detail;   ///< value, rule, cure
};

/// Rows of a record as read, which show why no model can be identified from it.
struct RecordSamples {
    std::size_t samples = 0;  ///< of the whole record
    std::vector<double> t, u, y;
    std::vector<double> r = {};           ///< empty: the record has none
    std::vector<double> move_times = {};  ///< of u (record_kind.h); empty: u does not move, or the times are unknown
};

/// Options of the method with which the request is feasible; a program can send it again with them.
struct Cure {
    std::string text;  ///< text of the button that applies it, e.g. "Use Ms = Mt = 1.603"
    std::vector<std::pair<std::string, double>> options;
};

struct Problem {
    int status = 500;
    std::string type = "about:blank";  ///< names the cause, e.g. "invalid-request", "no-feasible-controller"
    std::string title;
    std::string detail;
    std::vector<FieldError> errors;
    std::string instance;                      ///< optional
    std::optional<RecordSamples> record = {};  ///< of a record that was read but not identified
    std::optional<Cure> cure = {};             ///< set if the detail names values
};

/// The only table from the engine's error kinds to status, type and title.
Problem to_problem(const Error& error);

/// For a record that could not be identified: three rows show whether columns and times are right, more are for a plot.
constexpr std::size_t kExcerptRows = 3, kPlotRows = 2000;

/// At most `max` rows, evenly chosen, including the first and the last; rows in which t, u or y is not a number are
/// left out.
RecordSamples samples_of(const Record& record, std::size_t max = kExcerptRows);

std::string to_json(const Problem& problem);

}  // namespace tunewright::api
