#include "api/csv/pairs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>

#include "api/csv/cell.h"
#include "api/csv/columns/heading.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxPairs = 200, kMaxKeyLength = 60, kMaxLineLength = 20'000;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

void skip_blanks(std::string_view text, std::size_t& at) {
    while (at < text.size() && is_blank(text[at])) ++at;
}

/// The number "-12.5e-3" at `at`; empty if there is none.
std::string_view number_at(std::string_view text, std::size_t at) {
    std::size_t end = at;
    const auto digits = [&] {
        const std::size_t from = end;
        while (end < text.size() && is_digit(text[end])) ++end;
        return end > from;
    };
    if (end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
    bool any = digits();
    if (end + 1 < text.size() && text[end] == '.' && (any || is_digit(text[end + 1]))) {
        ++end;
        any = digits() || any;
    }
    if (!any) return {};
    // A decimal comma: behind a comma that separates pairs there is a name.
    const bool point = text.substr(at, end - at).find('.') != std::string_view::npos;
    if (end + 1 < text.size() && text[end] == ',' && !point && is_digit(text[end + 1])) {
        ++end;
        digits();
    }
    if (const std::size_t mantissa = end; end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
        ++end;
        if (end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
        if (!digits()) end = mantissa;
    }
    return text.substr(at, end - at);
}

std::string_view word_at(std::string_view text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end]))) ++end;
    return text.substr(at, end - at);
}

/// The value behind the sign of a pair: a number, a word that switches, or either of them or a time in quotes.
std::string_view value_at(std::string_view text, std::size_t& at) {
    skip_blanks(text, at);
    if (at < text.size() && (text[at] == '"' || text[at] == '\'')) {
        const std::size_t end = text.find(text[at], at + 1);
        if (end == text.npos) return {};
        const std::string_view inner = trimmed(text.substr(at + 1, end - at - 1));
        double number = 0;
        if (!read_cell_number(inner, number) && !read_time_stamp(inner) && !switch_word(inner)) return {};
        at = end + 1;
        return inner;
    }
    std::string_view value = number_at(text, at);
    // "12:05" and "1.2.3" are not numbers, and neither is "20ab4".
    if (!value.empty() && at + value.size() < text.size()) {
        const char next = text[at + value.size()];
        if (is_digit(next) || next == ':' || next == '.' || next == '_') value = {};
    }
    if (value.empty()) {
        const std::string_view word = word_at(text, at);
        if (switch_word(word)) value = word;
    }
    at += value.size();
    return value;
}

bool may_begin_key(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || c == '@' || static_cast<unsigned char>(c) >= 0x80;
}

bool is_unit(std::string_view word) {
    static constexpr std::string_view kUnits[] = {"C",  "F",  "K",  "degC", "degF", "\u00b0C", "\u00b0F",
                                                  "V",  "A",  "W",  "bar",  "rpm",  "s",       "ms",
                                                  "us", "Hz", "mA", "mV",   "kPa",  "Pa"};
    return std::find(std::begin(kUnits), std::end(kUnits), word) != std::end(kUnits) || word == "%";
}

/// The name in front of a sign: the text behind the last value, without separators, brackets and quotes.
std::string key_of(std::string_view between) {
    const std::size_t cut = between.find_last_of(",;|\t{[(>&");
    if (cut != between.npos) between.remove_prefix(cut + 1);
    const auto strip = [](char c) { return is_blank(c) || c == '"' || c == '\'' || c == ']' || c == ')' || c == '-'; };
    while (!between.empty() && strip(between.front())) between.remove_prefix(1);
    while (!between.empty() && strip(between.back())) between.remove_suffix(1);
    if (const std::size_t blank = between.find(' '); blank != between.npos && is_unit(between.substr(0, blank)))
        between = trimmed(between.substr(blank));
    if (between.size() > kMaxKeyLength || between.find_first_of("/\\:=#") != between.npos) {
        const std::size_t blank = between.find_last_of(' ');
        between = blank == between.npos ? std::string_view() : between.substr(blank + 1);
    }
    // A printer's word in front of its report.
    if (constexpr std::string_view kDone = "ok "; between.substr(0, kDone.size()) == kDone)
        between = trimmed(between.substr(kDone.size()));
    while (!between.empty() && is_digit(between.front())) {
        const std::size_t blank = between.find(' ');
        between = blank == between.npos ? std::string_view() : trimmed(between.substr(blank));
    }
    if (between.empty() || between.size() > kMaxKeyLength || !may_begin_key(between.front())) return {};
    return std::string(between);
}

/// Takes a time in front of a line: "[14:05:06.25] ", "2026-11-21 14:05:06,123 - ", "14:05:06 -> ", "Stats 123.4: ",
/// "[12.5]", "0.5 ".
std::size_t take_time(std::string_view line, std::vector<Pair>& out) {
    std::size_t at = 0;
    skip_blanks(line, at);
    const bool bracket = at < line.size() && line[at] == '[';
    if (bracket) ++at;
    constexpr std::size_t kMaxStampLength = 36;
    for (std::size_t end = std::min(line.size(), at + kMaxStampLength); end > at + 4; --end) {
        const bool whole =
            end == line.size() || is_blank(line[end]) || std::string_view(",;]|").find(line[end]) != line.npos;
        if (!whole || is_blank(line[end - 1]) || !is_digit(line[at])) continue;
        if (!read_time_stamp(line.substr(at, end - at))) continue;
        out.push_back({"time", line.substr(at, end - at)});
        return end;
    }
    // ESP-IDF: "I (1300) tag: ...", in milliseconds.
    if (line.size() > at + 4 && std::string_view("IWEDV").find(line[at]) != line.npos &&
        line.substr(at + 1, 2) == " (") {
        const std::string_view number = number_at(line, at + 3);
        const std::size_t end = at + 3 + number.size();
        if (!number.empty() && end < line.size() && line[end] == ')') {
            out.push_back({"time_ms", number});
            return end + 1;
        }
    }
    constexpr std::string_view kStats = "Stats ";
    const bool stats = line.substr(at, kStats.size()) == kStats;
    if (stats) at += kStats.size();
    skip_blanks(line, at);
    const std::string_view number = number_at(line, at);
    const std::size_t end = at + number.size();
    if (number.empty() || end >= line.size()) return 0;
    const char next = line[end];
    if ((bracket && next == ']') || (next == ':' && (stats || number.find('.') != number.npos))) {
        out.push_back({"time", number});
        return end + 1;
    }
    if (!bracket && (is_blank(next) || next == ',' || next == ';')) {
        out.push_back({"number in front", number});
        return end;
    }
    return 0;
}

// Takes the time at the end of an InfluxDB line, in ns since 1970.
void take_time_behind(std::string_view rest, std::vector<Pair>& out) {
    constexpr std::size_t kShortest = 10;
    rest = trimmed(rest);
    if (rest.size() < kShortest || out.empty() || out.front().key.starts_with("time")) return;
    if (std::all_of(rest.begin(), rest.end(), is_digit)) out.push_back({"time", rest});
}

/// Writes words for a printer's letters "T", "T0", "B@", "@", "@0" and for their set points.
void name_printer_letters(std::vector<Pair>& out) {
    const auto target = [&](const std::string& key) {
        return std::any_of(out.begin(), out.end(), [&](const Pair& pair) { return pair.key == key + ".target"; });
    };
    for (Pair& pair : out) {
        if (pair.key == "@" && target("T"))
            pair.key = "T.pwm";
        else if (pair.key.size() > 1 && pair.key.front() == '@' && target("T" + pair.key.substr(1)))
            pair.key = "T" + pair.key.substr(1) + ".pwm";
        else if (pair.key.size() > 1 && pair.key.back() == '@' && target(pair.key.substr(0, pair.key.size() - 1)))
            pair.key = pair.key.substr(0, pair.key.size() - 1) + ".pwm";
        else if (target(pair.key) && pair.key.size() <= 3)
            pair.key += ".temp";
    }
}

}  // namespace

void split_pairs(std::string_view line, std::vector<Pair>& out) {
    out.clear();
    if (line.size() > kMaxLineLength) return;
    std::size_t consumed = take_time(line, out);
    std::string group;
    for (std::size_t at = consumed; at < line.size() && out.size() < kMaxPairs;) {
        const std::size_t sign = line.find_first_of("=:", at);
        if (sign == line.npos) break;
        const std::string key = key_of(line.substr(consumed, sign - consumed));
        std::size_t value_from = sign + 1;
        const std::string_view value = value_at(line, value_from);
        if (key.empty() || value.empty()) {
            // "heater_bed: target=60": a word before a colon and a blank is part of the names of the following pairs.
            if (!key.empty() && line[sign] == ':' && sign + 1 < line.size() && is_blank(line[sign + 1])) {
                group = key;
                consumed = sign + 1;
            }
            at = sign + 1;
            continue;
        }
        std::string name = key;
        if (line[sign] == '=' && !group.empty()) name.insert(0, group + ".");
        out.push_back({std::move(name), value});
        consumed = value_from;
        std::size_t slash = consumed;
        skip_blanks(line, slash);
        if (slash < line.size() && line[slash] == '/') {
            ++slash;
            skip_blanks(line, slash);
            if (const std::string_view target = number_at(line, slash); !target.empty()) {
                out.push_back({out.back().key + ".target", target});
                consumed = slash + target.size();
            }
        }
        at = consumed;
    }
    take_time_behind(line.substr(consumed), out);
    name_printer_letters(out);
}

bool is_pair_line(const std::vector<Pair>& pairs, const std::vector<std::string>& keys) {
    std::size_t known = 0;
    for (const Pair& pair : pairs) known += std::find(keys.begin(), keys.end(), pair.key) != keys.end() ? 1 : 0;
    return known >= 2 && 2 * known >= keys.size();
}

namespace {

/// Lines with the same keys.
struct PairFamily {
    std::vector<std::string> keys;
    int lines = 0;

    bool holds(const std::vector<std::string>& wanted) const {
        return std::ranges::all_of(wanted, [&](const std::string& name) {
            return std::ranges::any_of(
                keys, [&](const std::string& key) { return lower_case(key) == lower_case(trimmed(name)); });
        });
    }

    /// True if it names a controller output and a measurement.
    bool is_process() const {
        bool u = false, y = false;
        for (const std::string& key : keys) {
            const Heading heading = split_heading(key);
            const auto output = match(heading, kOutputRole), input = match(heading, kInputRole);
            y = y || (output && !match(heading, kReferenceRole));
            u = u || (input && !output);
        }
        return u && y;
    }
};

/// Facts from the first lines of a text and a sample of the rest.
class PairFamilies {
public:
    void look_at(std::string_view content) {
        ++lines_;
        const bool stat = content.starts_with("Stats ");
        stats_ += stat ? 1 : 0;
        split_pairs(content, pairs_);
        const auto values = std::ranges::count_if(pairs_, [](const Pair& pair) {
            return pair.key != "time" && pair.key != "time_ms" && pair.key != "number in front";
        });
        if (values < 2) return;
        ++with_pairs_;
        std::vector<std::string> keys;
        for (const Pair& pair : pairs_)
            if (std::ranges::find(keys, pair.key) == keys.end()) keys.push_back(pair.key);
        ++families_[std::move(keys)];
    }

    /// True if there are enough lines of pairs for a log.
    bool may_be_log() const {
        constexpr int kFewStats = 3;
        return with_pairs_ > 1 && (2 * with_pairs_ >= lines_ || stats_ >= kFewStats);
    }

    int stats() const { return stats_; }

    /// The best family of all; it has fewer than 2 lines if there is none.
    PairFamily best(const std::vector<std::string>& wanted) const {
        constexpr int kFewRows = 8;
        PairFamily best;
        std::array<int, 3> rank{};
        for (const auto& [keys, lines] : families_) {
            const PairFamily now{keys, lines};
            const std::array<int, 3> at = {!wanted.empty() && lines > 1 && now.holds(wanted) ? 1 : 0,
                                           lines >= kFewRows && now.is_process() ? 1 : 0, lines};
            if (at <= rank) continue;
            rank = at;
            best = now;
        }
        return best;
    }

private:
    std::vector<Pair> pairs_;
    std::map<std::vector<std::string>, int> families_;
    int lines_ = 0, with_pairs_ = 0, stats_ = 0;
};

}  // namespace

std::vector<std::string> pair_keys(std::string_view text, const std::vector<std::string>& wanted) {
    constexpr int kProbedLines = 400, kProbeInterval = 16;  // lines examined, and then one line in every kProbeInterval
    constexpr std::size_t kLookedBytes = 4 << 20;
    PairFamilies families;
    // A line that may have the wanted columns contains the last parts of their names.
    const auto may_be_wanted = [&](std::string_view content) {
        return !wanted.empty() && std::ranges::all_of(wanted, [&](const std::string& name) {
            return name == "time" || content.find(name.substr(name.rfind('.') + 1)) != content.npos;
        });
    };
    text = text.substr(0, kLookedBytes);
    std::size_t at = 0;
    for (int number = 0; const auto line = next_line(text, at);) {
        const std::string_view content = trimmed(*line);
        if (content.empty()) continue;
        // The log of a printer may begin with a dump; its reports come later.
        const bool report = content.starts_with("Stats ") && families.stats() < kProbedLines;
        if (++number <= kProbedLines || report || number % kProbeInterval == 0 || may_be_wanted(content))
            families.look_at(content);
    }
    const PairFamily family = families.best(wanted);
    const bool named = !wanted.empty() && family.holds(wanted);
    if (family.lines < 2 || !(families.may_be_log() || named)) return {};
    return family.keys;
}

}  // namespace tunewright::api
