#include "api/csv/columns/loop_mode.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "api/csv/cell.h"
#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading_words.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

// In cascade the set point comes from another controller, but u from this one.
constexpr std::string_view kAutomatic[] = {"auto",        "automatic",  "aut", "a",    "automatik", "automatisch",
                                           "automatique", "automatico", "cas", "casc", "cascade",   "kaskade",
                                           "cascada",     "cascata",    "c",   "rcas", "bcas",      "remote cascade"};
constexpr std::string_view kManual[] = {"man",    "manual",         "m",       "hand",        "h",        "manuell",
                                        "manuel", "manuelle",       "manuale", "handbetrieb", "iman",     "init man",
                                        "lo",     "local override", "track",   "trk",         "tracking", "oos",
                                        "o/s",    "out of service", "rout",    "remote out",  "prd",      "off"};

bool is_number(std::string_view token) {
    return !token.empty() &&
           std::ranges::all_of(token, [](char c) { return std::isdigit(static_cast<unsigned char>(c)); });
}

/// Words and numbers, and each = or : by itself.
std::vector<std::string> tokens(std::string_view text) {
    std::vector<std::string> out;
    bool open = false;
    for (const char c : text) {
        const bool sign = c == '=' || c == ':';
        if (sign || !(std::isalnum(static_cast<unsigned char>(c)) || c == '/' || (c & 0x80) != 0)) {
            if (sign) out.emplace_back(1, c);
            open = false;
            continue;
        }
        if (!open) out.emplace_back();
        open = true;
        out.back() += c;
    }
    return out;
}

/// "0=MAN", "Auto: 1".
ModeCodes stated_codes(std::string_view text) {
    ModeCodes codes;
    const std::vector<std::string> all = tokens(text);
    for (std::size_t i = 1; i + 1 < all.size(); ++i) {
        if (all[i] != "=" && all[i] != ":") continue;
        const bool number_first = is_number(all[i - 1]);
        const std::string &number = number_first ? all[i - 1] : all[i + 1],
                          &word = number_first ? all[i + 1] : all[i - 1];
        const auto mode = mode_word(word);
        double value = 0;
        if (is_number(number) && mode && read_cell_number(number, value)) codes[value] = *mode;
    }
    // "AUTO=1": then 0 is manual.
    if (codes.size() == 1 && (codes.contains(0) || codes.contains(1)))
        codes[codes.contains(0) ? 1 : 0] = !codes.begin()->second;
    return codes;
}

}  // namespace

std::optional<bool> mode_word(std::string_view word) {
    const std::string known = lower_case(trimmed(word));
    if (is_one_of(known, kAutomatic)) return true;
    if (is_one_of(known, kManual)) return false;
    return std::nullopt;
}

ModeCodes mode_codes(const Heading& heading) {
    if (ModeCodes stated = stated_codes(heading.text); !stated.empty()) return stated;
    // "Auto/Man" names both, and a letter or a short word of a tag may be anything.
    const std::vector<std::string> all = words(heading.text);
    const auto names = [&](bool automatic) {
        constexpr std::size_t kShortest = 3;
        return std::ranges::any_of(
            all, [&](const std::string& word) { return word.size() >= kShortest && mode_word(word) == automatic; });
    };
    if (names(true) == names(false)) return {};
    return {{0, !names(true)}, {1, names(true)}};
}

std::optional<bool> ModeColumn::read(std::string_view cell) const {
    double number = 0;
    if (read_cell_number(cell, number)) {
        const auto code = codes_.find(number);
        return code == codes_.end() ? std::nullopt : std::optional(code->second);
    }
    // TRUE and FALSE under "AUTO", OFF under "MAN_ON".
    const auto level = switch_word(cell);
    const auto code = level ? codes_.find(*level) : codes_.end();
    return code == codes_.end() ? mode_word(cell) : std::optional(code->second);
}

bool ModeColumn::see(std::string_view cell) {
    constexpr std::size_t kMaxNamed = 5;
    if (is_missing(cell)) return false;
    seen_ = true;
    now_ = read(cell);
    known_ = known_ || now_;
    const std::string word(trimmed(cell));
    if (!now_ && unknown_words_.size() < kMaxNamed && std::ranges::find(unknown_words_, word) == unknown_words_.end())
        unknown_words_.push_back(word);
    return true;
}

void ModeColumn::add_row() {
    if (!seen_) ++before_;
    rows_.push_back(now_.value_or(false));
    if (seen_ && !now_) ++unknown_rows_;
}

std::vector<bool> ModeColumn::take() {
    if (!known_) return {};
    if (before_ < rows_.size()) std::fill_n(rows_.begin(), before_, bool(rows_[before_]));
    return std::move(rows_);
}

std::string ModeColumn::unknown() const {
    if (unknown_words_.empty()) return "";
    std::vector<std::string> quoted;
    for (const std::string& word : unknown_words_) quoted.push_back(in_quotes(word));
    const std::string words =
        listed(quoted, "and") + (quoted.size() == 1 ? " is not a known mode" : " are not known modes");
    if (!known_) return words + ", so the mode is not used. Known are AUTO and CAS for automatic, and MAN.";
    return words + " of the loop: " + std::to_string(unknown_rows_) +
           (unknown_rows_ == 1 ? " row counts" : " rows count") +
           " as manual. Known are AUTO and CAS for automatic, and MAN.";
}

}  // namespace tunewright::api
