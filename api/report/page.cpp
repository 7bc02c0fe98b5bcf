#include "api/report/page.h"

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "api/embed/files.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

/// The number in `text` at `from`; -1 if there is none.
int number_at(const std::string& text, std::size_t from, std::size_t length) {
    int value = -1;
    const char* const end = text.data() + from + length;
    const auto read = std::from_chars(text.data() + from, end, value);
    return read.ec == std::errc() && read.ptr == end ? value : -1;
}

}  // namespace

const std::string& stylesheet() {
    static const std::string text(embedded_file("report/report.css"));
    return text;
}

std::string page(const std::string& title, const Html& body, const std::string& css_class) {
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

std::string date_words(const std::string& date, std::optional<int> utc_offset_min) {
    using namespace std::chrono;
    constexpr std::size_t kMinuteLength = 16;  // "2024-05-01T12:00"
    if (date.size() <= kMinuteLength || date[10] != 'T' || date.back() != 'Z') return date;
    const year_month_day day{year(number_at(date, 0, 4)), month(static_cast<unsigned>(number_at(date, 5, 2))),
                             std::chrono::day(static_cast<unsigned>(number_at(date, 8, 2)))};
    const int hour = number_at(date, 11, 2), minute = number_at(date, 14, 2), offset = utc_offset_min.value_or(0);
    if (!day.ok() || hour < 0 || minute < 0) return date;
    const auto time = sys_days(day) + hours(hour) + minutes(minute + offset);
    const auto midnight = floor<days>(time);
    const year_month_day there(midnight);
    const hh_mm_ss clock(time - midnight);
    char text[64];
    std::snprintf(text, sizeof text, "%04d-%02u-%02u %02d:%02d UTC", int(there.year()), unsigned(there.month()),
                  unsigned(there.day()), int(clock.hours().count()), int(clock.minutes().count()));
    std::string words = text;
    if (!utc_offset_min) return words;
    std::snprintf(text, sizeof text, "%c%02d:%02d", offset < 0 ? '-' : '+', std::abs(offset) / 60,
                  std::abs(offset) % 60);
    return words + text;
}

Html head_of(const ReportInput& subject, const ReportWords& words, const std::string& title, const std::string& about) {
    std::string origin;
    for (const auto& [name, value] : {std::pair{"", date_words(words.date, words.utc_offset_min)},
                                      {"job ", words.job},
                                      {"Tunewright ", text_at(subject.result.at("version"))}})
        if (!value.empty()) origin += (origin.empty() ? "" : " · ") + std::string(name) + value;
    Html out = element("h1", title) + element("p", about) + element("p", origin);
    const std::string hash = text_at(subject.result.at("request_hash"));
    if (!hash.empty()) out += element("p", "Request " + hash, {{"class", "hash"}});
    return element("header", out);
}

std::string about_of(const ReportInput& subject) {
    const std::string title = text_at(subject.entry.at("title")), controller = controller_words(subject);
    return (controller.empty() ? "Controller settings" : "Settings of " + controller) +
           ", by: " + (title.empty() ? text_at(subject.entry.at("method")) : title);
}

Html signatures() {
    Html out;
    for (const char* line : {"Prepared by, date", "Checked by, date", "Entered in the controller by, date"})
        out += element("p", line);
    return element("div", out, {{"class", "sign"}});
}

ReportWords said_of(const ChosenEntry& found, const ReportWords& words) {
    ReportWords said = words;
    for (const auto& [word, known] :
         {std::pair{&said.job, &found.job}, {&said.name, &found.name}, {&said.date, &found.date}})
        if (word->empty()) *word = *known;
    return said;
}

std::string title_of(const ReportInput& subject, const ReportWords& said, const std::string& kind,
                     const std::string& alone) {
    const std::string name = said.name.empty() ? text_at(subject.request.at("name")) : said.name;
    return name.empty() ? alone : name + ": " + kind;
}

bool is_of_range(const Json& result) {
    return result.is_object() && result.contains("range") && result["range"].is_object();
}

}  // namespace tunewright::api
