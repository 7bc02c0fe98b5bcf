// GET /v1/jobs/{id}/report.html and `tunewright report`: one controller of a result as a page to print, sign and keep;
// GET /v1/batches/{id}/report.html: the loops of a batch of checks.
//
//   const auto page = report_html({job.result, job.request}, "", {.job = job.id, .date = "2024-05-01T12:00:00Z"});
//   if (const auto* text = std::get_if<std::string>(&page)) ...
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/report/page.h"

namespace tunewright::api {

/// The report of a controller; with `index` "" of an operating range or of a check if the source is about one. HTML
/// without scripts, well-formed XML. `index`: number of the controller in the result; "" for the first of the ranking
/// that is not today's. 404 if there is no such controller, or it has none; 400 and 422 for texts that are not JSON.
std::variant<std::string, Problem> report_html(const ResultSource& source, std::string_view index,
                                               const ReportWords& words);

/// The report of many loops. Only the loops that have a page are in memory with their drawings.
class BatchReport {
public:
    /// `check`: BatchCheck of the document, without drawings.
    explicit BatchReport(std::string_view check);

    /// The loops with a page, by their places in the check.
    std::vector<std::size_t> pages() const;
    /// Takes the drawings of the loop at `place` from the result of its job, in which it has the place `within`.
    void add_drawings(std::size_t place, std::string_view result, std::size_t within);
    /// Names an entry without an answer.
    void add_failed(std::string name, std::string reason);

    /// `name`: of the batch.
    std::string html(const std::string& name, const ReportWords& words) const;

private:
    Json document_;
    std::vector<std::pair<std::string, std::string>> failed_;
};

/// The content security policy of report and change sheets: it allows only the stylesheet inside it, by its hash.
std::string report_policy();

}  // namespace tunewright::api
