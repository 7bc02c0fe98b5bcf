// The subject of a report, a summary and a plot: one controller of a result, by its places in the document.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/chosen_entry.h"
#include "api/json/json.h"

namespace tunewright::api {

/// The result with a pointer to the part that is shown.
struct JsonLocation {
    const Json& root;
    std::string pointer;

    /// Null if there is none.
    const Json& value() const;
    JsonLocation at(std::string_view name) const;
    JsonLocation at(std::size_t index) const;
    bool exists() const { return !value().is_null(); }
};

/// A text at the place; "" for none.
std::string text_at(const JsonLocation& place);

/// The list at the place, with NaN for an element that is not a number; empty if it is not a list.
std::vector<double> numbers_at(const JsonLocation& place);

/// The subject of a section: places in one document {result, request}.
struct ReportInput {
    JsonLocation result, request, entry;
    JsonLocation given;                 ///< the request's given controller that the entry is about, if it is one
    std::size_t index = 0;              ///< of the entry among the result's controllers
    std::optional<JsonLocation> today;  ///< the baseline's entry, if there is one other than the entry
    std::string time, u, y;             ///< labels of the units; "" if not given, except for time
};

/// The subject for the document's controller number `index`.
ReportInput subject_of(const Json& document, std::size_t index);

/// The subject for the document's operating range, which takes the place of the entry.
ReportInput subject_of_range(const Json& document);

/// The subject for the document's check: its entry is the list of loops.
ReportInput subject_of_check(const Json& document);

/// The subject for the document's structure: its entry is the whole result.
ReportInput subject_of_structure(const Json& document);

/// The same with the labels of these units, if they are an object.
ReportInput with_units(const ReportInput& subject, const Json& units);

/// The first of the ranking that is not today's; today's if it is the only one.
std::size_t best_proposal(const ChosenEntry& found);

/// {"result", "request"} of the chosen entry, moved out of it.
Json document_of(ChosenEntry& found);

}  // namespace tunewright::api
