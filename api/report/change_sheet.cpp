#include "api/report/change_sheet.h"

#include "api/report/sections.h"
#include "engine/request/entry.h"

namespace tunewright::api {
namespace {

/// `title`: of a job without a name.
Html sheet(const ReportInput& subject, const ReportWords& said, const std::string& title) {
    return head_of(subject, said, title, about_of(subject)) + settings_section(subject, TodayColumn::always) +
           reason_section(subject) + effect_section(subject) + way_back_section(subject) + signatures();
}

Problem no_sheet(int status, std::string sentence) {
    return {status,
            status == 404 ? "not-found" : "invalid-request",
            status == 404 ? "Not Found" : "Unprocessable Content",
            std::move(sentence),
            {},
            {}};
}

struct TitledSheet {
    std::string title;
    Html body;
};

/// `alone`: the title for a job without a name.
std::variant<TitledSheet, Problem> sheet_of(const ResultSource& source, std::string_view index,
                                            const ReportWords& words, const std::string& alone) try {
    ChosenEntry found;
    if (auto problem = read_result(source, found)) return *std::move(problem);
    if (is_of_range(found.result))
        return no_sheet(404, "An operating range has no change sheet; its report has the schedule to enter.");
    std::string today;
    auto made = about_entry(found, index, words, [&](const ReportInput& subject, const ReportWords& said) {
        if (text_at(subject.entry.at("method")) == kBaselineMethod) today = std::to_string(subject.index);
        const std::string title = title_of(subject, said, "change sheet", alone);
        return today.empty() ? TitledSheet{title, sheet(subject, said, title)} : TitledSheet{};
    });
    if (!today.empty())
        return no_sheet(422, "Controller " + today + " has today's settings, which change nothing. Choose a design.");
    return made;
} catch (const Json::exception&) {
    return not_a_result();
}

/// Why a loop has no sheet.
std::string reason_of(const BatchLoop& loop) {
    if (loop.status == "cancelled") return "Cancelled.";
    if (loop.status == "queued" || loop.status == "running") return "Not tuned yet.";
    const Json error = Json::parse(loop.error, nullptr, false);
    return error.is_object() ? error.value("detail", "") : "";
}

}  // namespace

std::variant<std::string, Problem> change_sheet_html(const ResultSource& source, std::string_view index,
                                                     const ReportWords& words) {
    auto made = sheet_of(source, index, words, "Change sheet");
    if (auto* problem = std::get_if<Problem>(&made)) return std::move(*problem);
    const auto& [title, body] = std::get<TitledSheet>(made);
    return page(title, body, "sheet");
}

void ChangeSheets::add(const BatchLoop& loop) {
    ++loops_;
    const std::string number = "Loop " + std::to_string(loop.index + 1);
    std::string reason;
    if (loop.source.result.empty()) {
        reason = reason_of(loop);
    } else {
        const auto made = sheet_of(loop.source, "", loop.words, number + ": change sheet");
        if (const auto* titled = std::get_if<TitledSheet>(&made)) {
            sheets_ += element("div", titled->body, {{"class", "sheet"}});
            return;
        }
        reason = std::get<Problem>(made).detail;
    }
    left_out_ += element("tr", element("th", number, {{"scope", "row"}}) + element("td", loop.words.name) +
                                   element("td", reason.empty() ? "It has no result." : reason));
}

std::string ChangeSheets::page(const std::string& batch, const std::string& next) const {
    Html body;
    if (!next.empty())
        body += element("p",
                        Html("This part has ") + std::to_string(loops_) + " loops. " +
                            element("a", "The next part", {{"href", next}}) + " has the others.",
                        {{"class", "screen"}});
    body += sheets_;
    if (!left_out_.empty())
        body += element("div",
                        element("header", element("h1", batch + ": loops without a change sheet")) +
                            element("table", element("tbody", left_out_), {{"class", "left-out"}}),
                        {{"class", "sheet"}});
    return api::page(batch + ": change sheets", body);
}

}  // namespace tunewright::api
