#include "api/report/report.h"

#include "api/embed/files.h"
#include "api/json/digest.h"
#include "api/report/figures.h"
#include "api/report/sections.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

const std::string& stylesheet() {
    static const std::string text(embedded_file("report/report.css"));
    return text;
}

std::string about_of(const ReportInput& subject) {
    const std::string title = text_at(subject.entry.at("title")), controller = controller_words(subject);
    return (controller.empty() ? "Controller settings" : "Settings of " + controller) +
           ", by: " + (title.empty() ? text_at(subject.entry.at("method")) : title);
}

/// The date in words: "2024-05-01 12:00 UTC" for "2024-05-01T12:00:00Z"; another text unchanged.
std::string date_words(const std::string& date) {
    constexpr std::size_t kDateLength = 10, kMinuteLength = 16;
    if (date.size() <= kMinuteLength || date[kDateLength] != 'T' || date.back() != 'Z') return date;
    return date.substr(0, kDateLength) + " " + date.substr(kDateLength + 1, kMinuteLength - kDateLength - 1) + " UTC";
}

Html head_of(const ReportInput& subject, const ReportWords& words, const std::string& title, const std::string& about) {
    std::string origin;
    for (const auto& [name, value] : {std::pair{"", date_words(words.date)},
                                      {"job ", words.job},
                                      {"Tunewright ", text_at(subject.result.at("version"))}})
        if (!value.empty()) origin += (origin.empty() ? "" : " · ") + std::string(name) + value;
    Html out = element("h1", title) + element("p", about) + element("p", origin);
    const std::string hash = text_at(subject.result.at("request_hash"));
    if (!hash.empty()) out += element("p", "Request " + hash, {{"class", "hash"}});
    return element("header", out);
}

Html signatures() {
    Html out;
    for (const char* line : {"Prepared by, date", "Checked by, date", "Entered in the controller by, date"})
        out += element("p", line);
    return element("div", out, {{"class", "sign"}});
}

std::string page(const std::string& title, const Html& body, const std::string& css_class = "") {
    return "<!DOCTYPE html>\n" +
           element("html",
                   element("head", empty_element("meta", {{"charset", "utf-8"}}) + element("title", title) +
                                       empty_element("meta", {{"name", "viewport"},
                                                              {"content", "width=device-width, initial-scale=1"}}) +
                                       element("style", Html::trusted(stylesheet()))) +
                       element("body", element("main", body, {{"class", css_class}})),
                   {{"xmlns", "http://www.w3.org/1999/xhtml"}, {"lang", "en"}})
               .markup() +
           "\n";
}

/// Uses the facts of a whole job in the source if the caller gives none.
ReportWords said_of(const ChosenEntry& found, const ReportWords& words) {
    return {.job = words.job.empty() ? found.job : words.job,
            .name = words.name.empty() ? found.name : words.name,
            .date = words.date.empty() ? found.date : words.date,
            .origin = words.origin};
}

/// "TIC-101: tuning report" for `kind` "tuning report"; `alone` if the job has no name.
std::string title_of(const ReportInput& subject, const ReportWords& said, const char* kind, const char* alone) {
    const std::string name = said.name.empty() ? text_at(subject.request.at("name")) : said.name;
    return name.empty() ? alone : name + ": " + kind;
}

std::string report_title(const ReportInput& subject, const ReportWords& said) {
    return title_of(subject, said, "tuning report", "Tuning report");
}

bool is_of_range(const Json& result) {
    return result.is_object() && result.contains("range") && result["range"].is_object();
}

std::string range_report(ChosenEntry& found, const ReportWords& words) {
    const ReportWords said = said_of(found, words);
    const Json document = document_of(found);
    const ReportInput subject = subject_of_range(document);
    const std::string title = report_title(subject, said);
    const JsonLocation scheduling = subject.entry.at("scheduling");
    const auto end = [&](const char* name) { return tunewright::text(scheduling.at(name).value().get<double>(), 6); };
    const std::string about = "Operating range: " + text_at(scheduling.at("name")) + " from " + end("from") + " to " +
                              end("to") + " " + text_at(scheduling.at("unit"));
    return page(title, head_of(subject, said, title, about) + range_sections(subject) + signatures() +
                           request_section(document.at("request"), said.origin));
}

std::string full_report(const ReportInput& subject, const ReportWords& said) {
    const std::string title = report_title(subject, said);
    return page(title, head_of(subject, said, title, about_of(subject)) + verdict_section(subject) +
                           settings_section(subject, TodayColumn::if_known) + figures_section(subject) +
                           responses_section(subject) + robustness_section(subject) + plant_section(subject) +
                           method_section(subject) + assumptions_section(subject) + signatures() +
                           forms_section(subject) + request_section(subject.request.value(), said.origin));
}

std::string change_sheet(const ReportInput& subject, const ReportWords& said) {
    const std::string title = title_of(subject, said, "change sheet", "Change sheet");
    return page(title,
                head_of(subject, said, title, about_of(subject)) + settings_section(subject, TodayColumn::always) +
                    reason_section(subject) + effect_section(subject) + way_back_section(subject) + signatures(),
                "sheet");
}

/// Calls `write` for the controller number `index` of the result that was read.
template <class Write>
std::variant<std::string, Problem> page_about(ChosenEntry& found, std::string_view index, const ReportWords& words,
                                              const Write& write) {
    if (auto problem = find_entry(index, found)) return *std::move(problem);
    const std::size_t number = index.empty() ? best_proposal(found) : found.index;
    const ReportWords said = said_of(found, words);
    const Json document = document_of(found);
    return write(subject_of(document, number), said);
}

Problem no_sheet(int status, std::string sentence) {
    return {status,
            status == 404 ? "not-found" : "invalid-request",
            status == 404 ? "Not Found" : "Unprocessable Content",
            std::move(sentence),
            {},
            {}};
}

}  // namespace

std::variant<std::string, Problem> report_html(const ResultSource& source, std::string_view index,
                                               const ReportWords& words) try {
    ChosenEntry found;
    if (auto problem = read_result(source, found)) return *std::move(problem);
    if (index.empty() && is_of_range(found.result)) return range_report(found, words);
    return page_about(found, index, words, full_report);
} catch (const Json::exception&) {  // a file that only resembles a result: its members have other types
    return not_a_result();
}

std::variant<std::string, Problem> change_sheet_html(const ResultSource& source, std::string_view index,
                                                     const ReportWords& words) try {
    ChosenEntry found;
    if (auto problem = read_result(source, found)) return *std::move(problem);
    if (is_of_range(found.result))
        return no_sheet(404, "An operating range has no change sheet; its report has the schedule to enter.");
    return page_about(found, index, words,
                      [](const ReportInput& subject, const ReportWords& said) -> std::variant<std::string, Problem> {
                          if (text_at(subject.entry.at("method")) == "baseline")
                              return no_sheet(422, "Controller " + std::to_string(subject.index) +
                                                       " has today's settings, which change nothing. Choose a design.");
                          return change_sheet(subject, said);
                      });
} catch (const Json::exception&) {
    return not_a_result();
}

std::string report_policy() {
    static const std::string policy = "default-src 'none'; style-src 'sha256-" + sha256_base64(stylesheet()) +
                                      "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    return policy;
}

}  // namespace tunewright::api
