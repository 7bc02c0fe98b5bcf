#include "api/report/report.h"

#include <algorithm>

#include "api/contract/structure/structure_name.h"
#include "api/json/digest.h"
#include "api/report/check_words.h"
#include "api/report/figures.h"
#include "api/report/sections.h"
#include "api/report/structure/structure_words.h"
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

std::string structure_report(ChosenEntry& found, const ReportWords& words) {
    const ReportWords said = said_of(found, words);
    const Json document = document_of(found);
    const ReportInput subject = subject_of_structure(document);
    const std::string title = report_title(subject, said);
    return page(title, head_of(subject, said, title, structure_title(text_at(subject.result.at("structure")))) +
                           structure_sections(subject) + signatures() +
                           request_section(document.at("request"), said.origin));
}

/// Entries without an answer, with their reasons.
Html failed_section(const std::vector<std::pair<std::string, std::string>>& failed) {
    constexpr std::size_t kMaxNamed = 100;
    if (failed.empty()) return {};
    std::vector<Html> items;
    for (std::size_t i = 0; i < std::min(failed.size(), kMaxNamed); ++i) {
        const auto& [name, reason] = failed[i];
        items.emplace_back((name.empty() ? "Without a name" : name) + ": " +
                           (reason.empty() ? "It has no result." : reason));
    }
    if (failed.size() > kMaxNamed) items.emplace_back(std::to_string(failed.size() - kMaxNamed) + " more.");
    return section("Not checked", list(items));
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
    if (index.empty() && !structure_of(found.result).empty()) return structure_report(found, words);
    return about_entry(found, index, words, full_report);
} catch (const Json::exception&) {  // a file that only resembles a result: its members have other types
    return not_a_result();
}

BatchReport::BatchReport(std::string_view check) { document_["result"] = Json::parse(check); }

std::vector<std::size_t> BatchReport::pages() const { return loops_with_page(document_["result"]); }

void BatchReport::add_drawings(std::size_t place, std::string_view result, std::size_t within) {
    const Json parsed = Json::parse(result, nullptr, false);
    const Json* loops = parsed.is_object() && parsed.contains("loops") ? &parsed["loops"] : nullptr;
    if (loops == nullptr || within >= loops->size()) return;
    for (const char* part : {"trend", "excerpt", "spectrum"})
        document_["result"]["loops"][place][part] = (*loops)[within].value(part, Json());
}

void BatchReport::add_failed(std::string name, std::string reason) {
    failed_.emplace_back(std::move(name), std::move(reason));
}

std::string BatchReport::html(const std::string& name, const ReportWords& words) const {
    const ReportInput subject = subject_of_check(document_);
    const Json& result = document_["result"];
    const std::string title = name.empty() ? "Loop check" : name + ": loop check";
    Html out = head_of(subject, words, title, check_summary(result));
    if (!result.value("complete", true))
        out += element("p", element("strong", "The batch has not ended; loops that are not checked yet are missing."));
    return page(title, out + failed_section(failed_) + check_sections(subject));
}

std::string report_policy() {
    static const std::string policy = "default-src 'none'; style-src 'sha256-" + sha256_base64(stylesheet()) +
                                      "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    return policy;
}

}  // namespace tunewright::api
