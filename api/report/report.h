// GET /v1/jobs/{id}/report.html and `tunewright report`: one controller of a result as a page to print, sign and keep;
// GET /v1/jobs/{id}/change-sheet.html: the same on one sheet of paper, for those who enter the settings.
//
//   const auto page = report_html({job.result, job.request}, "", {.job = job.id, .date = "2024-05-01T12:00:00Z"});
//   if (const auto* text = std::get_if<std::string>(&page)) ...
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "api/chosen_entry.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// Facts for a report other than the result: each may be "", and is then taken from a whole job in the source.
struct ReportWords {
    std::string job;     ///< id
    std::string name;    ///< of the job
    std::string date;    ///< "2024-05-01T12:00:00Z"
    std::string origin;  ///< where the service answers, "http://host:8080"
};

/// The report of a controller, or of an operating range if the source is about one and `index` is "". HTML without
/// scripts, well-formed XML. `index`: number of the controller in the result; "" for the first of the ranking that is
/// not today's. 404 if there is no such controller, or it has none; 400 and 422 for texts that are not JSON.
std::variant<std::string, Problem> report_html(const ResultSource& source, std::string_view index,
                                               const ReportWords& words);

/// The change sheet of a controller: today's and the new settings, reason, expected effect, lines to sign and the way
/// back. Input and problems as for report_html; also 404 for an operating range, 422 if the controller is today's.
std::variant<std::string, Problem> change_sheet_html(const ResultSource& source, std::string_view index,
                                                     const ReportWords& words);

/// The content security policy of both pages: it allows only the stylesheet inside it, by its hash.
std::string report_policy();

}  // namespace tunewright::api
