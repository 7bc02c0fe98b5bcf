// The frame of a page to print: its stylesheet, its head, the lines to sign.
#pragma once

#include <optional>
#include <string>

#include "api/chosen_entry.h"
#include "api/report/html.h"
#include "api/report/report_input.h"

namespace tunewright::api {

/// Facts for a page other than the result: each may be "", and is then taken from a whole job in the source.
struct ReportWords {
    std::string job;                    ///< id
    std::string name;                   ///< of the job
    std::string date;                   ///< "2024-05-01T12:00:00Z"
    std::string origin;                 ///< where the service answers, "http://host:8080"
    std::optional<int> utc_offset_min;  ///< of the reader's clock, minutes ahead of UTC; empty: dates are in UTC
};

/// The largest difference of a clock from UTC, in minutes.
inline constexpr int kMaxUtcOffset = 14 * 60;

const std::string& stylesheet();

/// The whole document. HTML without scripts, well-formed XML.
std::string page(const std::string& title, const Html& body, const std::string& css_class = "");

/// "2024-05-01 14:00 UTC+02:00" for "2024-05-01T12:00:00Z" and an offset of 120; "... UTC" without one; another text
/// unchanged.
std::string date_words(const std::string& date, std::optional<int> utc_offset_min);

/// The head about a result: title, subject, date, job and version.
Html head_of(const ReportInput& subject, const ReportWords& words, const std::string& title, const std::string& about);

/// "Settings of ..., by: ...": the user's controller and the method.
std::string about_of(const ReportInput& subject);

Html signatures();

/// Uses the facts of a whole job in the source if the caller gives none.
ReportWords said_of(const ChosenEntry& found, const ReportWords& words);

/// "TIC-101: tuning report" for `kind` "tuning report"; `alone` if the job has no name.
std::string title_of(const ReportInput& subject, const ReportWords& said, const std::string& kind,
                     const std::string& alone);

bool is_of_range(const Json& result);

/// The answer of `write` for the controller number `index` of what was read; "": the first of the ranking that is not
/// today's.
template <class Write>
auto about_entry(ChosenEntry& found, std::string_view index, const ReportWords& words, const Write& write)
    -> std::variant<decltype(write(std::declval<const ReportInput&>(), words)), Problem> {
    if (auto problem = find_entry(index, found)) return *std::move(problem);
    const std::size_t number = index.empty() ? best_proposal(found) : found.index;
    const ReportWords said = said_of(found, words);
    const Json document = document_of(found);
    return write(subject_of(document, number), said);
}

}  // namespace tunewright::api
