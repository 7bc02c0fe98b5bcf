// What a report, a summary and a plot are about: one controller of a result, found by its places in the document.
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

    /// Null where there is none.
    const Json& value() const;
    JsonLocation at(std::string_view name) const;
    JsonLocation at(std::size_t index) const;
    bool exists() const { return !value().is_null(); }
};

/// A text at the place; "" for none.
std::string text_at(const JsonLocation& place);

/// The list at the place, not a number where an element is none; empty for no list.
std::vector<double> numbers_at(const JsonLocation& place);

/// What a section is about: places in one document {result, request}.
struct ReportInput {
    JsonLocation result, request, entry;
    std::size_t index = 0;              ///< of the entry among the result's controllers
    std::optional<JsonLocation> today;  ///< the baseline's entry, where there is one beside the entry
    std::string time, u, y;             ///< labels of the units; "" where not given, but for time
};

/// Of the document's controller number `index`.
ReportInput subject_of(const Json& document, std::size_t index);

/// Of the document's operating range, which is the entry then.
ReportInput subject_of_range(const Json& document);

/// The first of the ranking that is not what runs today; that, where it stands alone.
std::size_t best_proposal(const ChosenEntry& found);

/// {"result", "request"} of what was chosen, which is taken out of it.
Json document_of(ChosenEntry& found);

}  // namespace tunewright::api
