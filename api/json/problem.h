// application/problem+json (RFC 9457): what a client gets when something cannot be done.
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

/// Rows of a record as it was read: what a reader needs to see why it determines no model.
struct RecordSamples {
    std::size_t samples = 0;  ///< of the whole record
    std::vector<double> t, u, y;
    std::vector<double> r = {};           ///< empty: the record has none
    std::vector<double> move_times = {};  ///< of u (record_kind.h); empty: it does not move, or cannot be told
};

/// What would make the request possible: options of its method, for a program to send it again with.
struct Cure {
    std::string text;  ///< what a button that does it says, e.g. "Use Ms = Mt = 1.603"
    std::vector<std::pair<std::string, double>> options;
};

struct Problem {
    int status = 500;
    std::string type = "about:blank";  ///< names the cause, e.g. "invalid-request", "no-feasible-controller"
    std::string title;
    std::string detail;
    std::vector<FieldError> errors;
    std::string instance;                      ///< optional
    std::optional<RecordSamples> record = {};  ///< of a record that was read, but not identified
    std::optional<Cure> cure = {};             ///< where the detail names values
};

/// The one table from the engine's error kinds to status, type and title.
Problem to_problem(const Error& error);

/// Of a record that could not be identified: three rows tell whether columns and times are what they should be, more
/// are for a plot.
constexpr std::size_t kExcerptRows = 3, kPlotRows = 2000;

/// At most so many rows, evenly chosen, the first and the last among them; rows in which t, u or y is no number are
/// left out.
RecordSamples samples_of(const Record& record, std::size_t max = kExcerptRows);

std::string to_json(const Problem& problem);

}  // namespace tunewright::api
