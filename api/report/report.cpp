#include "api/report/report.h"

#include "api/embed/files.h"
#include "api/json/digest.h"
#include "api/report/figures.h"

namespace tunewright::api {
namespace {

const std::string& stylesheet() {
    static const std::string text(embedded_file("report/report.css"));
    return text;
}

Html head_of(const ReportSubject& subject, const ReportWords& words, const std::string& title) {
    std::string line = text_at(subject.entry.at("title"));
    if (line.empty()) line = text_at(subject.entry.at("method"));
    std::string origin;
    for (const auto& [name, value] :
         {std::pair{"Date ", words.date}, {"job ", words.job}, {"Tunewright ", text_at(subject.result.at("version"))}})
        if (!value.empty()) origin += (origin.empty() ? "" : " · ") + std::string(name) + value;
    Html out = element("h1", title) + element("p", "Controller settings by: " + line) + element("p", origin);
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

std::string page(const std::string& title, const Html& body) {
    return "<!DOCTYPE html>\n" +
           element("html",
                   element("head", empty_element("meta", {{"charset", "utf-8"}}) + element("title", title) +
                                       empty_element("meta", {{"name", "viewport"},
                                                              {"content", "width=device-width, initial-scale=1"}}) +
                                       element("style", Html::trusted(stylesheet()))) +
                       element("body", element("main", body)),
                   {{"xmlns", "http://www.w3.org/1999/xhtml"}, {"lang", "en"}})
               .markup() +
           "\n";
}

}  // namespace

std::variant<std::string, Problem> report_html(const ResultSource& source, std::string_view index,
                                               const ReportWords& words) try {
    auto chosen = choose_entry(source, index);
    if (auto* problem = std::get_if<Problem>(&chosen)) return std::move(*problem);
    auto& found = std::get<ChosenEntry>(chosen);
    const std::size_t number = index.empty() ? best_proposal(found) : found.index;
    const ReportWords said{.job = words.job.empty() ? found.job : words.job,
                           .name = words.name.empty() ? found.name : words.name,
                           .date = words.date.empty() ? found.date : words.date,
                           .origin = words.origin};
    const Json document = document_of(found);
    const ReportSubject subject = subject_of(document, number);

    const std::string name = said.name.empty() ? text_at(subject.request.at("name")) : said.name;
    const std::string title = name.empty() ? "Tuning report" : name + ": tuning report";
    return page(title, head_of(subject, said, title) + verdict_section(subject) + settings_section(subject) +
                           figures_section(subject) + responses_section(subject) + robustness_section(subject) +
                           plant_section(subject) + method_section(subject) + assumptions_section(subject) +
                           signatures() + request_section(document.at("request"), said.origin));
} catch (const Json::exception&) {  // a file that only looks like a result: its members are of other kinds
    return not_a_result();
}

std::string report_policy() {
    static const std::string policy = "default-src 'none'; style-src 'sha256-" + sha256_base64(stylesheet()) +
                                      "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    return policy;
}

}  // namespace tunewright::api
