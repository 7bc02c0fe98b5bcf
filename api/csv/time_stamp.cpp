#include "api/csv/time_stamp.h"

#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <string>
#include <utility>

namespace tunewright::api {
namespace {

// Reads exactly `digits` digits, or 1 to 2 if `digits` is 0.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
    std::size_t count = 0;
    const std::size_t most = digits == 0 ? 2 : digits;
    while (count < text.size() && count < most && std::isdigit(static_cast<unsigned char>(text[count]))) ++count;
    if (count == 0 || (digits != 0 && count != digits)) return std::nullopt;
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

std::optional<double> take_fraction(std::string_view& text) {
    if (!take(text, ".,")) return 0.0;
    double value = 0, weight = 0.1;
    bool any = false;
    while (!text.empty() && std::isdigit(static_cast<unsigned char>(text.front()))) {
        value += weight * (text.front() - '0');
        weight *= 0.1;
        any = true;
        text.remove_prefix(1);
    }
    if (!any) return std::nullopt;
    return value;
}

std::optional<double> take_clock(std::string_view& text) {
    const auto hour = take_digits(text, 0);
    if (!hour || *hour > 24 || !take(text, ":")) return std::nullopt;
    const auto minute = take_digits(text, 2);
    if (!minute || *minute > 59) return std::nullopt;
    double seconds = 3600.0 * *hour + 60.0 * *minute;
    if (take(text, ":")) {
        const auto second = take_digits(text, 2);
        if (!second || *second > 60) return std::nullopt;
        const auto fraction = take_fraction(text);
        if (!fraction) return std::nullopt;
        seconds += *second + *fraction;
    }
    return seconds;
}

std::optional<double> take_zone(std::string_view& text) {
    while (take(text, " ")) {
    }
    if (text.empty() || take(text, "Zz")) return 0.0;
    const double sign = text.front() == '-' ? -1 : 1;
    if (!take(text, "+-")) return std::nullopt;
    const auto hour = take_digits(text, 2);
    if (!hour) return std::nullopt;
    take(text, ":");
    const auto minute = text.empty() ? 0 : take_digits(text, 2);
    if (!minute) return std::nullopt;
    return sign * (3600.0 * *hour + 60.0 * *minute);
}

std::optional<double> take_date(std::string_view& text) {
    const auto year = take_digits(text, 4);
    if (!year || !take(text, "-/")) return std::nullopt;
    const auto month = take_digits(text, 2);
    if (!month || !take(text, "-/")) return std::nullopt;
    const auto day = take_digits(text, 2);
    if (!day) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                           std::chrono::day(static_cast<unsigned>(*day))};
    if (!date.ok()) return std::nullopt;
    return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

}  // namespace

std::optional<TimeStamp> read_time_stamp(std::string_view text) {
    if (text.size() < 4 || text.size() > 40 || !std::isdigit(static_cast<unsigned char>(text.front())))
        return std::nullopt;
    std::string_view rest = text;
    TimeStamp stamp;
    if (const auto date = take_date(rest)) {
        stamp = {*date, true};
        if (rest.empty()) return stamp;
        if (!take(rest, "Tt ")) return std::nullopt;
    } else {
        rest = text;
    }
    const auto clock = take_clock(rest);
    if (!clock) return std::nullopt;
    const auto zone = take_zone(rest);
    if (!zone || !rest.empty()) return std::nullopt;
    stamp.seconds += *clock - *zone;
    return stamp;
}

std::optional<double> seconds_per(std::string_view unit) {
    static constexpr std::array<std::pair<std::string_view, double>, 26> kUnits = {{{"s", 1},
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
                                                                                    {"days", 86400}}};
    std::string lower;
    for (const char c : unit) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [name, seconds] : kUnits) {
        if (lower == name) return seconds;
    }
    return std::nullopt;
}

}  // namespace tunewright::api
