// GET /v1/jobs/{id}/change-sheet.html: one controller of a result on one sheet of paper, for those who enter the
// settings; GET /v1/batches/{id}/change-sheet.html: the same for the loops of a batch.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "api/report/page.h"

namespace tunewright::api {

/// Today's and the new settings, reason, expected effect, lines to sign and the way back. Input and problems as for
/// report_html; also 404 for an operating range, 422 if the controller is today's.
std::variant<std::string, Problem> change_sheet_html(const ResultSource& source, std::string_view index,
                                                     const ReportWords& words);

/// A loop of a batch in its current state; the texts must outlive the call.
struct BatchLoop {
    std::int64_t index = 0;   ///< position in the batch, from 0
    std::string_view status;  ///< of its job
    ResultSource source;      ///< `result` is "" if it has none
    std::string_view error;   ///< JSON; "" if none
    ReportWords words;
};

/// Loops of a batch on one page: a sheet for the best proposal of each that has one, in the order in which they are
/// added, then one sheet that lists the others with their reasons.
class ChangeSheets {
public:
    void add(const BatchLoop& loop);
    std::size_t loops() const { return loops_; }  ///< added so far
    std::size_t bytes() const { return sheets_.markup().size() + left_out_.markup().size(); }

    /// `batch`: its name. `next`: address of the page with the loops that follow; "" if there are none.
    std::string page(const std::string& batch, const std::string& next) const;

private:
    Html sheets_;
    Html left_out_;  ///< rows of the list
    std::size_t loops_ = 0;
};

}  // namespace tunewright::api
