// GET /v1/jobs/{id}/report.html and `tunewright report`: one controller of a result as a page to print, sign and keep.
//
//   const auto page = report_html({job.result, job.request}, "", {.job = job.id, .date = "2024-05-01T12:00:00Z"});
//   if (const auto* text = std::get_if<std::string>(&page)) ...
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "api/report/page.h"

namespace tunewright::api {

/// The report of a controller; with `index` "" of an operating range or of a check if the source is about one. HTML
/// without scripts, well-formed XML. `index`: number of the controller in the result; "" for the first of the ranking
/// that is not today's. 404 if there is no such controller, or it has none; 400 and 422 for texts that are not JSON.
std::variant<std::string, Problem> report_html(const ResultSource& source, std::string_view index,
                                               const ReportWords& words);

/// The content security policy of report and change sheets: it allows only the stylesheet inside it, by its hash.
std::string report_policy();

}  // namespace tunewright::api
