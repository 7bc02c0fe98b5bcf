#include "api/csv/time_stamp.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "api/csv/cell.h"
#include "api/csv/text.h"

namespace tunewright::api {
namespace {

// Reads `min` to `max` digits.
std::optional<int> take_digits(std::string_view& text, std::size_t min, std::size_t max) {
    std::size_t count = 0;
    while (count < text.size() && count < max && is_digit(text[count])) ++count;
    if (count < min) return std::nullopt;
    int value = 0;
    std::from_chars(text.data(), text.data() + count, value);
    text.remove_prefix(count);
    return value;
}

bool take(std::string_view& text, std::string_view any_of) {
    if (text.empty() || any_of.find(text.front()) == any_of.npos) return false;
    text.remove_prefix(1);
    return true;
}

void take_blanks(std::string_view& text) {
    while (take(text, " ")) {
    }
    // The narrow no-break space in front of AM and PM on some systems.
    if (text.substr(0, 3) == "\xE2\x80\xAF") text.remove_prefix(3);
    if (text.substr(0, 2) == "\xC2\xA0") text.remove_prefix(2);
}

std::optional<double> take_fraction(std::string_view& text) {
    // Some historians write milliseconds after another colon.
    if (!take(text, ".,:")) return 0.0;
    double value = 0, weight = 0.1;
    bool any = false;
    while (!text.empty() && is_digit(text.front())) {
        value += weight * (text.front() - '0');
        weight *= 0.1;
        any = true;
        text.remove_prefix(1);
    }
    if (!any) return std::nullopt;
    return value;
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Reads AM, PM, a.m. or p.m.: true for PM; empty for none of them.
std::optional<bool> take_half_of_day(std::string_view& text) {
    std::string_view rest = text;
    take_blanks(rest);
    if (rest.size() < 2) return std::nullopt;
    const char half = lower(rest.front());
    const bool dotted = rest[1] == '.';
    const std::size_t m = dotted ? 2 : 1;
    if ((half != 'a' && half != 'p') || rest.size() <= m || lower(rest[m]) != 'm') return std::nullopt;
    rest.remove_prefix(m + 1);
    if (dotted) take(rest, ".");
    text = rest;
    return half == 'p';
}

/// Reads 07:20.5, a spreadsheet's time below an hour; nothing may follow.
std::optional<double> take_minutes(std::string_view& text) {
    std::string_view rest = text;
    const auto minute = take_digits(rest, 1, 2);
    if (!minute || !take(rest, ":")) return std::nullopt;
    const auto second = take_digits(rest, 2, 2);
    if (!second || *second > 59 || rest.size() < 2 || (rest.front() != '.' && rest.front() != ',')) return std::nullopt;
    const auto fraction = take_fraction(rest);
    if (!fraction || !rest.empty()) return std::nullopt;
    text = rest;
    return 60.0 * *minute + *second + *fraction;
}

constexpr int kHoursOfDay = 24;

std::optional<double> take_clock(std::string_view& text) {
    std::string_view rest = text;
    const bool basic = rest.size() >= 6 && rest.find(':') == rest.npos;
    const auto hour = take_digits(rest, basic ? 2 : 1, 2);
    if (!hour || (!basic && !take(rest, ":"))) return std::nullopt;
    const auto minute = take_digits(rest, 2, 2);
    if (!minute || *minute > 59 || (*hour > kHoursOfDay && !rest.empty())) return std::nullopt;
    double seconds = 3600.0 * *hour + 60.0 * *minute;
    if (basic || take(rest, ":")) {
        const auto second = take_digits(rest, 2, 2);
        if (!second || *second > 60) return std::nullopt;
        const auto fraction = take_fraction(rest);
        if (!fraction) return std::nullopt;
        seconds += *second + *fraction;
    }
    if (const auto afternoon = take_half_of_day(rest)) {
        if (*hour < 1 || *hour > 12) return std::nullopt;
        seconds += (*afternoon ? 12 * 3600.0 : 0) - (*hour == 12 ? 12 * 3600.0 : 0);
    }
    text = rest;
    return seconds;
}

struct Zone {
    double seconds = 0;
    bool given = false;
};

std::optional<Zone> take_zone(std::string_view& text) {
    take_blanks(text);
    if (text.empty()) return Zone{};
    if (text == "UTC" || text == "GMT") text.remove_prefix(3);
    if (text.empty() || take(text, "Zz")) return Zone{0, true};
    const double sign = text.front() == '-' ? -1 : 1;
    if (!take(text, "+-")) return std::nullopt;
    const auto hour = take_digits(text, 2, 2);
    if (!hour) return std::nullopt;
    take(text, ":");
    const auto minute = text.empty() ? 0 : take_digits(text, 2, 2);
    if (!minute) return std::nullopt;
    return Zone{sign * (3600.0 * *hour + 60.0 * *minute), true};
}

// The first three or four letters of the months in the languages that the header lists.
constexpr std::array<std::string_view, 12> kMonths = {"jan gen ene",
                                                      "feb f\xC3\xA9v fev",
                                                      "mar mrz m\xC3\xA4r mrt",
                                                      "apr avr abr",
                                                      "may mai mag mei mayo",
                                                      "jun juin giu",
                                                      "jul juil lug",
                                                      "aug ao\xC3\xBB aou ago",
                                                      "sep set",
                                                      "oct okt ott",
                                                      "nov",
                                                      "dec dez d\xC3\xA9\x63 dic"};

std::optional<int> take_month_name(std::string_view& text) {
    std::string word;
    std::size_t length = 0;
    while (length < text.size() && (std::isalpha(static_cast<unsigned char>(text[length])) || (text[length] & 0x80)))
        word += lower(text[length++]);
    if (word.size() < 3) return std::nullopt;
    for (std::size_t month = 0; month < kMonths.size(); ++month) {
        std::string_view names = kMonths[month];
        while (!names.empty()) {
            const std::string_view name = names.substr(0, names.find(' '));
            names.remove_prefix(std::min(names.size(), name.size() + 1));
            if (word.rfind(name, 0) != 0) continue;
            text.remove_prefix(length);
            take(text, ".");
            return static_cast<int>(month) + 1;
        }
    }
    return std::nullopt;
}

std::optional<double> days_as_seconds(int year, int month, int day) {
    if (year < 100) year += year < 80 ? 2000 : 1900;
    if (month < 1 || day < 1) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) return std::nullopt;
    return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

struct Date {
    double seconds = 0;
    bool order_matters = false;
};

std::optional<Date> dated(std::optional<double> seconds) {
    if (!seconds) return std::nullopt;
    return Date{*seconds, false};
}

std::size_t leading_digits(std::string_view text) {
    return std::min(text.find_first_not_of("0123456789"), text.size());
}

// 20240301120000: the first eight of its digits.
constexpr std::size_t kDateDigits = 8, kCompactDigits = 14;

std::optional<Date> take_compact_date(std::string_view& text) {
    if (leading_digits(text) != kCompactDigits || (text.substr(0, 2) != "19" && text.substr(0, 2) != "20"))
        return std::nullopt;
    std::string_view rest = text;
    const auto year = take_digits(rest, 4, 4), month = take_digits(rest, 2, 2), day = take_digits(rest, 2, 2);
    constexpr int kFirstYear = 1970;
    if (!year || *year < kFirstYear || !month || !day) return std::nullopt;
    const auto seconds = days_as_seconds(*year, *month, *day);
    if (seconds) text.remove_prefix(kDateDigits);
    return dated(seconds);
}

// Reads 2024-03-01, 2024/3/1, 2024.03.01, 20240301.
std::optional<Date> take_year_first(std::string_view& text) {
    std::string_view rest = text;
    const auto year = take_digits(rest, 4, 4);
    if (!year) return std::nullopt;
    const bool apart = take(rest, "-/.");
    const auto month = take_digits(rest, apart ? 1 : 2, 2);
    if (!month || (apart && !take(rest, "-/."))) return std::nullopt;
    const auto day = take_digits(rest, apart ? 1 : 2, 2);
    if (!day || (!rest.empty() && is_digit(rest.front()))) return std::nullopt;
    text = rest;
    return dated(days_as_seconds(*year, *month, *day));
}

// Reads 01-Mar-24, 1 March 2024, Mar 1, 2024.
std::optional<Date> take_named_month(std::string_view& text) {
    std::string_view rest = text;
    auto month = take_month_name(rest);
    const bool month_first = month.has_value();
    if (month_first) take_blanks(rest);
    const auto day = take_digits(rest, 1, 2);
    if (!day) return std::nullopt;
    take(rest, ".,");
    if (!month_first) {
        take_blanks(rest);
        take(rest, "-/");
        month = take_month_name(rest);
        if (!month) return std::nullopt;
    }
    take(rest, "-/,");
    take_blanks(rest);
    const auto year = take_digits(rest, 2, 4);
    if (!year) return std::nullopt;
    text = rest;
    return dated(days_as_seconds(*year, *month, *day));
}

// Reads 1.3.2024, 01/03/24, 3-1-2024.
std::optional<Date> take_year_last(std::string_view& text, DateOrder order) {
    std::string_view rest = text;
    const auto first = take_digits(rest, 1, 2);
    if (!first || rest.empty()) return std::nullopt;
    const char between = rest.front();
    if (!take(rest, "./-")) return std::nullopt;
    const auto second = take_digits(rest, 1, 2);
    if (!second || rest.empty() || rest.front() != between) return std::nullopt;
    rest.remove_prefix(1);
    const auto year = take_digits(rest, 2, 4);
    if (!year) return std::nullopt;
    text = rest;
    const auto day_first = days_as_seconds(*year, *second, *first);
    if (between == '.') return dated(day_first);
    const auto month_first = days_as_seconds(*year, *first, *second);
    if (!day_first || !month_first) return dated(day_first ? day_first : month_first);
    return Date{order == DateOrder::day_first ? *day_first : *month_first, *day_first != *month_first};
}

void skip_weekday(std::string_view& text) {
    std::size_t length = 0;
    while (length < text.size() && std::isalpha(static_cast<unsigned char>(text[length]))) ++length;
    std::string_view rest = text;
    if (length < 2 || take_month_name(rest)) return;
    rest = text.substr(length);
    take(rest, ".");
    take(rest, ",");
    take_blanks(rest);
    text = rest;
}

/// Converts "03/09/2024;23:55:00;7", date, clock and milliseconds, to "03/09/2024 23:55:00.007"; "" for another text.
std::string joined_stamp(std::string_view text) {
    constexpr std::size_t kMillisecondDigits = 3;
    const std::size_t clock = text.find(';'), millis = std::min(text.find(';', clock + 1), text.size());
    std::string_view digits = text.substr(std::min(millis + 1, text.size()));
    if (digits.size() > kMillisecondDigits || !std::ranges::all_of(digits, is_digit)) return {};
    std::string out =
        std::string(text.substr(0, clock)) + " " + std::string(text.substr(clock + 1, millis - clock - 1));
    if (!digits.empty()) out += "." + std::string(kMillisecondDigits - digits.size(), '0') + std::string(digits);
    return out;
}

}  // namespace

std::optional<TimeStamp> read_time_stamp(std::string_view text, DateOrder order) {
    constexpr std::size_t kShortest = 4, kLongest = 48;
    if (text.size() < kShortest || text.size() > kLongest) return std::nullopt;
    if (text.find(';') != text.npos) {
        const std::string joined = joined_stamp(text);
        return joined.empty() ? std::nullopt : read_time_stamp(joined, order);
    }
    std::string_view rest = text;
    if (!is_digit(rest.front())) skip_weekday(rest);
    TimeStamp stamp;
    auto date = take_compact_date(rest);
    const bool compact = date.has_value();
    if (!date) date = take_year_first(rest);
    if (!date) date = take_year_last(rest, order);
    if (!date) date = take_named_month(rest);
    if (date) {
        stamp.seconds = date->seconds;
        stamp.has_date = true;
        stamp.order_matters = date->order_matters;
        if (!compact && rest.empty()) {
            // Eight digits alone are a number.
            if (text.find_first_not_of("0123456789") == text.npos) return std::nullopt;
            return stamp;
        }
        take(rest, ",");
        if (!compact && !take(rest, "Tt :_") && rest.substr(0, 2) != "\xC2\xA0") return std::nullopt;
        take_blanks(rest);
    } else if (!is_digit(text.front()) || text.find(':') == text.npos) {
        return std::nullopt;
    }
    auto clock = date ? std::nullopt : take_minutes(rest);
    stamp.minutes = clock.has_value();
    if (!clock) clock = take_clock(rest);
    if (!clock || (date && *clock > kHoursOfDay * 3600.0)) return std::nullopt;
    const auto zone = take_zone(rest);
    if (!zone || !rest.empty()) return std::nullopt;
    stamp.has_clock = true;
    stamp.has_zone = zone->given;
    stamp.seconds += *clock - zone->seconds;
    return stamp;
}

bool is_compact_stamp(std::string_view text) {
    return leading_digits(text) == kCompactDigits && read_time_stamp(text).has_value();
}

std::optional<double> seconds_per(std::string_view unit) {
    static constexpr std::array<std::pair<std::string_view, double>, 43> kUnits = {{{"s", 1},
                                                                                    {"sec", 1},
                                                                                    {"secs", 1},
                                                                                    {"second", 1},
                                                                                    {"seconds", 1},
                                                                                    {"ms", 1e-3},
                                                                                    {"msec", 1e-3},
                                                                                    {"millisecond", 1e-3},
                                                                                    {"milliseconds", 1e-3},
                                                                                    {"us", 1e-6},
                                                                                    {"usec", 1e-6},
                                                                                    {"microseconds", 1e-6},
                                                                                    {"ns", 1e-9},
                                                                                    {"min", 60},
                                                                                    {"mins", 60},
                                                                                    {"minute", 60},
                                                                                    {"minutes", 60},
                                                                                    {"m", 60},
                                                                                    {"h", 3600},
                                                                                    {"hr", 3600},
                                                                                    {"hrs", 3600},
                                                                                    {"hour", 3600},
                                                                                    {"hours", 3600},
                                                                                    {"d", 86400},
                                                                                    {"day", 86400},
                                                                                    {"days", 86400},
                                                                                    {"sek", 1},
                                                                                    {"sekunden", 1},
                                                                                    {"std", 3600},
                                                                                    {"stunden", 3600},
                                                                                    {"tage", 86400},
                                                                                    {"\xC2\xB5s", 1e-6},
                                                                                    {"nsec", 1e-9},
                                                                                    {"minuten", 60},
                                                                                    {"segundos", 1},
                                                                                    {"secondi", 1},
                                                                                    {"seconden", 1},
                                                                                    {"minutos", 60},
                                                                                    {"minuti", 60},
                                                                                    {"heures", 3600},
                                                                                    {"horas", 3600},
                                                                                    {"uren", 3600},
                                                                                    {"secondes", 1}}};
    double count = 1;
    const auto [end, fault] = std::from_chars(unit.data(), unit.data() + unit.size(), count);
    if (fault == std::errc{}) unit = trimmed(unit.substr(static_cast<std::size_t>(end - unit.data())));
    std::string lower;
    for (const char c : unit) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [name, seconds] : kUnits) {
        if (lower == name && count > 0 && std::isfinite(count)) return count * seconds;
    }
    return std::nullopt;
}

}  // namespace tunewright::api
