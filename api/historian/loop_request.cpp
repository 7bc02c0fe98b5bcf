#include "api/historian/loop_request.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "api/csv/time_stamp.h"
#include "api/historian/tags/loop_tags.h"
#include "api/json/writer.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxNameLength = 200;  ///< of a request

void append_number(std::string& out, double value) {
    std::array<char, 32> digits;
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    out.append(digits.data(), written.ptr);
}

/// A cell in quotes if its text needs them.
void append_word(std::string& out, const std::string& word) {
    if (word.find_first_of(",\"\r\n") == std::string::npos) {
        out += word;
        return;
    }
    out += '"';
    for (const char c : word) out += c == '"' ? "\"\"" : std::string(1, c);
    out += '"';
}

/// The rows as CSV, t counted from `zero`. sp and mode are written where they change.
std::string rows_text(const TaggedLoop& loop, double zero) {
    constexpr std::size_t kTypicalLine = 32;
    std::string out = "t,sp,pv,op,mode\n";
    out.reserve(loop.t.size() * kTypicalLine);
    double r = std::nan("");
    std::size_t mode = 0;
    for (std::size_t i = 0; i < loop.t.size(); ++i) {
        const std::size_t start = out.size();
        append_number(out, loop.t[i] - zero);
        // 1.234 alone may be a thousand; one number that cannot be shows that . is the decimal sign.
        if (i == 0 && out.find_first_of(".e", start) == std::string::npos) out += ".0";
        out += ',';
        if (!loop.r.empty() && !std::isnan(loop.r[i]) && loop.r[i] != r) append_number(out, r = loop.r[i]);
        out += ',';
        if (!std::isnan(loop.y[i])) append_number(out, loop.y[i]);
        out += ',';
        if (!std::isnan(loop.u[i])) append_number(out, loop.u[i]);
        out += ',';
        if (!loop.mode.empty() && loop.mode[i] != mode) append_word(out, loop.mode_words[mode = loop.mode[i]]);
        out += '\n';
    }
    return out;
}

void write_columns(const TaggedLoop& loop, Writer& out) {
    out.key("columns").begin_object();
    int number = 0;
    for (const auto& [role, there] :
         {std::pair{"t", true}, {"r", !loop.r.empty()}, {"y", true}, {"u", true}, {"mode", !loop.mode.empty()}}) {
        ++number;
        if (there) out.key(role).integer(number);
    }
    out.end_object();
}

}  // namespace

std::string iso_time(double seconds, bool utc) {
    constexpr double kMillisecondsPerSecond = 1000;
    const auto millis = std::chrono::milliseconds(std::llround(seconds * kMillisecondsPerSecond));
    const auto day = std::chrono::floor<std::chrono::days>(std::chrono::sys_time<std::chrono::milliseconds>(millis));
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(millis -
                                      std::chrono::duration_cast<std::chrono::milliseconds>(day.time_since_epoch()));
    std::array<char, 40> text;
    std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%03d", static_cast<int>(date.year()),
                  static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                  static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                  static_cast<int>(clock.seconds().count()), static_cast<int>(clock.subseconds().count()));
    std::string out = text.data();
    while (out.back() == '0') out.pop_back();
    if (out.back() == '.') out.pop_back();
    return utc ? out + "Z" : out;
}

std::string loop_request(const TaggedLoop& loop, const CheckTerms& terms, const Json& known) {
    const auto seconds = seconds_per(terms.time_unit);
    const bool dated = loop.epoch && seconds && !loop.t.empty();
    const double zero = dated ? loop.t.front() : 0;
    Writer out;
    out.begin_object();
    if (loop.tag.size() <= kMaxNameLength) out.key("name").text(loop.tag);
    if (terms.unit_given) {
        out.key("units").begin_object();
        out.key("time").text(terms.time_unit);
        out.end_object();
    }
    if (terms.settings) out.key("settings").boolean(true);
    out.key("loops").begin_array();
    out.begin_object();
    out.key("tag").text(loop.tag);
    const std::string_view kind = kind_of_tag(loop.tag).name;
    if (!kind.empty() && !known.contains("kind")) out.key("kind").text(kind);
    for (const auto& [member, value] : known.items()) out.key(member).raw(value.dump());
    out.key("csv").text(rows_text(loop, zero));
    write_columns(loop, out);
    if (seconds) out.key("time_unit").text(terms.time_unit);
    if (dated) out.key("start").text(iso_time(*loop.epoch + zero * *seconds, loop.utc));
    if (const std::vector<std::string> notes = reading_notes(loop); !notes.empty()) {
        out.key("notes").begin_array();
        for (const std::string& note : notes) out.text(note);
        out.end_array();
    }
    out.end_object();
    out.end_array();
    out.end_object();
    return out.take();
}

}  // namespace tunewright::api
