#include "api/report/report.h"

#include "api/json/digest.h"
#include "api/report/check_words.h"
#include "api/report/figures.h"
#include "api/report/sections.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

std::string report_title(const ReportInput& subject, const ReportWords& said) {
    return title_of(subject, said, "tuning report", "Tuning report");
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

std::string check_report(ChosenEntry& found, const ReportWords& words) {
    const ReportWords said = said_of(found, words);
    const Json document = document_of(found);
    const ReportInput subject = subject_of_check(document);
    const std::string title = title_of(subject, said, "loop check", "Loop check");
    return page(title, head_of(subject, said, title, check_summary(subject.result.value())) + check_sections(subject) +
                           request_section(document.at("request"), said.origin));
}

std::string full_report(const ReportInput& subject, const ReportWords& said) {
    const std::string title = report_title(subject, said);
    return page(title, head_of(subject, said, title, about_of(subject)) + verdict_section(subject) +
                           settings_section(subject, TodayColumn::if_known) + figures_section(subject) +
                           responses_section(subject) + own_step_section(subject) + robustness_section(subject) +
                           plant_section(subject) + method_section(subject) + assumptions_section(subject) +
                           signatures() + forms_section(subject) +
                           request_section(subject.request.value(), said.origin));
}

}  // namespace

std::variant<std::string, Problem> report_html(const ResultSource& source, std::string_view index,
                                               const ReportWords& words) try {
    ChosenEntry found;
    if (auto problem = read_result(source, found)) return *std::move(problem);
    if (index.empty() && is_of_range(found.result)) return range_report(found, words);
    if (index.empty() && is_of_check(found.result)) return check_report(found, words);
    return about_entry(found, index, words, full_report);
} catch (const Json::exception&) {  // a file that only resembles a result: its members have other types
    return not_a_result();
}

std::string report_policy() {
    static const std::string policy = "default-src 'none'; style-src 'sha256-" + sha256_base64(stylesheet()) +
                                      "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    return policy;
}

}  // namespace tunewright::api
