#include "api/csv/cell.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>

#include "api/csv/text.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxNumberLength = 64;

constexpr std::string_view kMinusSign = "\xE2\x88\x92", kEnDash = "\xE2\x80\x93";

/// The length of a minus sign as in typeset text.
std::size_t typeset_minus(std::string_view cell) {
    return cell.starts_with(kMinusSign) || cell.starts_with(kEnDash) ? kMinusSign.size() : 0;
}

std::string_view without_sign(std::string_view cell) {
    if (!cell.empty() && (cell.front() == '-' || cell.front() == '+')) cell.remove_prefix(1);
    cell.remove_prefix(typeset_minus(cell));
    return cell;
}

// True for "1,234" and "12.345.678": one to three digits, then groups of three; false for "0,123".
bool is_grouped(std::string_view cell, char group) {
    cell = without_sign(cell);
    const std::size_t first = cell.find(group);
    if (first == cell.npos || first == 0 || first > 3 || cell.front() == '0') return false;
    if (!std::all_of(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(first), is_digit)) return false;
    for (std::size_t at = first; at < cell.size(); at += 4) {
        if (cell[at] != group || at + 4 > cell.size()) return false;
        if (!is_digit(cell[at + 1]) || !is_digit(cell[at + 2]) || !is_digit(cell[at + 3])) return false;
    }
    return true;
}

bool parse(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// Removes a blank, a no-break space (also the narrow one) or an apostrophe between thousands.
std::string without_blanks_between_digits(std::string_view cell) {
    std::string out;
    for (std::size_t i = 0; i < cell.size(); ++i) {
        std::size_t length = 0;
        if (cell[i] == ' ' || cell[i] == '\'') length = 1;
        if (cell.substr(i, 2) == "\xC2\xA0") length = 2;
        if (cell.substr(i, 3) == "\xE2\x80\xAF" || cell.substr(i, 3) == "\xE2\x80\x99") length = 3;
        const bool between = length > 0 && !out.empty() && is_digit(out.back()) && i + length < cell.size() &&
                             is_digit(cell[i + length]);
        if (!between) {
            out += cell[i];
            continue;
        }
        std::size_t digits = 0;
        while (i + length + digits < cell.size() && is_digit(cell[i + length + digits])) ++digits;
        if (digits != 3) return std::string(cell);
        i += length - 1;
    }
    return out;
}

// For a `text` with a comma or several points: the decimal sign becomes a point and the other sign is removed.
bool parse_signs(std::string text, DecimalSign sign, double& value) {
    const auto points = std::count(text.begin(), text.end(), '.'), commas = std::count(text.begin(), text.end(), ',');
    char decimal = commas > 0 ? ',' : '.';
    if (points > 0 && commas > 0) {
        decimal = text.rfind(',') > text.rfind('.') ? ',' : '.';
    } else if (points + commas > 1 || (sign == DecimalSign::point && commas == 1) ||
               (sign == DecimalSign::comma && points == 1)) {
        const char group = commas > 0 ? ',' : '.';
        if (is_grouped(text, group)) decimal = group == ',' ? '.' : ',';
    }
    const char group = decimal == ',' ? '.' : ',';
    if (std::count(text.begin(), text.end(), decimal) > 1) return false;
    const std::size_t end = std::min(text.find(decimal), text.find_first_of("eE"));
    if (text.find(group) != text.npos && !is_grouped(text.substr(0, end), group)) return false;
    std::erase(text, group);
    std::replace(text.begin(), text.end(), ',', '.');
    return parse(text, value);
}

}  // namespace

void DecimalSignFinder::look_at(std::string_view cell, std::size_t column) {
    double value = 0;
    if (column >= columns_.size()) columns_.resize(column + 1);
    Column& here = columns_[column];
    if (cell.find_first_of(".,") == cell.npos) {
        const std::string_view digits = without_sign(cell);
        if (digits.empty() || !std::ranges::all_of(digits, is_digit) || digits.front() == '0') return;
        here.hundreds = here.hundreds || digits.size() == 3;
        here.thousands = here.thousands || digits.size() > 3;
        return;
    }
    if (!read_cell_number(cell, value, DecimalSign::either, unit_suffix(cell))) return;
    const bool points = cell.find('.') != cell.npos, commas = cell.find(',') != cell.npos;
    if (points && commas) {
        (cell.rfind(',') > cell.rfind('.') ? comma_ : point_) = true;
        return;
    }
    const char sign = points ? '.' : ',';
    if (!is_grouped(cell, sign)) {
        (points ? point_ : comma_) = true;
    } else if (std::count(cell.begin(), cell.end(), sign) > 1) {
        (points ? comma_ : point_) = true;
    } else {
        (points ? here.points : here.commas) = true;
        if (open_.empty()) open_ = std::string(cell);
    }
}

DecimalSign DecimalSignFinder::found() const {
    if (point_ != comma_) return point_ ? DecimalSign::point : DecimalSign::comma;
    if (point_) return DecimalSign::either;
    // A writer that writes 950 without decimals would also write 1 without them, so 1.050 is a thousand.
    const auto groups = [](bool points) {
        return [points](const Column& column) { return column.of_groups() && column.points == points; };
    };
    const bool by_points = std::ranges::any_of(columns_, groups(true));
    const bool by_commas = std::ranges::any_of(columns_, groups(false));
    if (by_points == by_commas) return DecimalSign::either;
    return by_points ? DecimalSign::comma : DecimalSign::point;
}

bool read_cell_number(std::string_view cell, double& value, DecimalSign sign, std::string_view suffix) {
    if (!suffix.empty() && cell.size() > suffix.size() && cell.ends_with(suffix)) {
        cell.remove_suffix(suffix.size());
        cell = trimmed(cell);
    }
    if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
    std::string plain;
    if (const std::size_t minus = typeset_minus(cell); minus > 0) cell = plain = "-" + std::string(cell.substr(minus));
    if (cell.empty() || !(is_digit(cell.front()) || cell.front() == '-' || cell.front() == '.' || cell.front() == ','))
        return false;
    const bool comma = cell.find(',') != cell.npos;
    if (!comma && sign != DecimalSign::comma && parse(cell, value)) return true;
    if (cell.size() > kMaxNumberLength) return false;
    if (!comma && cell.find_first_of(". '\xC2\xE2") == cell.npos) return parse(cell, value);
    return parse_signs(without_blanks_between_digits(cell), sign, value);
}

std::string_view unit_suffix(std::string_view cell) {
    if (cell.empty() || !(is_digit(without_sign(cell).substr(0, 1).empty() ? ' ' : without_sign(cell).front())))
        return {};
    const std::size_t last = cell.find_last_of("0123456789.");
    std::string_view suffix = trimmed(cell.substr(last + 1));
    constexpr std::size_t kLongest = 12;
    if (suffix.empty() || suffix.size() > kLongest || suffix.find_first_of(":+-/\\,") == 0 ||
        suffix.find_first_of("<>(){}") != suffix.npos)
        return {};
    double value = 0;
    return read_cell_number(cell, value, DecimalSign::either, suffix) ? suffix : std::string_view();
}

bool is_missing(std::string_view cell) {
    if (cell.empty()) return true;
    if (is_digit(cell.front()) || (cell.front() == '-' && cell.size() > 1 && is_digit(cell[1]))) return false;
    constexpr std::size_t kLongest = 20;
    if (cell.size() > kLongest) return false;
    static constexpr std::string_view kMarks[] = {
        "unavailable", "missing",    "-",           "--",          "---",           "?",
        "*",           ".",          "nan",         "1.#qnan",     "1.#ind",        "na",
        "n/a",         "null",       "(null)",      "none",        "nil",           "\\n",
        "#n/a",        "#na",        "#nv",         "#num!",       "#zahl!",        "#value!",
        "#wert!",      "#ref!",      "#bezug!",     "#div/0!",     "#name?",        "#valeur!",
        "bad",         "bad input",  "bad value",   "bad data",    "bad quality",   "no data",
        "no value",    "no sample",  "nodata",      "i/o timeout", "io timeout",    "timeout",
        "comm fail",   "comm error", "pt created",  "shutdown",    "not connected", "stale",
        "invalid",     "error",      "calc failed", "scan off",    "unknown",       "configure"};
    std::string word = lower_case(cell);
    if (word.size() > 1 && word.front() == '-' && std::isalpha(static_cast<unsigned char>(word[1]))) word.erase(0, 1);
    return std::find(std::begin(kMarks), std::end(kMarks), word) != std::end(kMarks);
}

std::optional<double> switch_word(std::string_view cell) {
    static constexpr std::string_view kHigh[] = {
        "on",      "true",  "open",    "opened",  "yes",    "running", "run",       "active",  "enabled", "high",
        "started", "start", "heating", "cooling", "ein",    "an",      "auf",       "wahr",    "ja",      "marche",
        "ouvert",  "vrai",  "oui",     "acceso",  "aperto", "vero",    "encendido", "abierto", "one"};
    static constexpr std::string_view kLow[] = {
        "off",   "false", "closed", "close",  "no",     "stopped", "stop",    "inactive",     "disabled",
        "low",   "idle",  "aus",    "zu",     "falsch", "nein",    "arret",   "arr\xC3\xAAt", "ferm\xC3\xA9",
        "ferme", "faux",  "non",    "spento", "chiuso", "falso",   "apagado", "cerrado",      "zero"};
    constexpr std::size_t kLongest = 10;
    if (cell.empty() || cell.size() > kLongest || is_digit(cell.front())) return std::nullopt;
    const std::string word = lower_case(cell);
    if (std::find(std::begin(kHigh), std::end(kHigh), word) != std::end(kHigh)) return 1;
    if (std::find(std::begin(kLow), std::end(kLow), word) != std::end(kLow)) return 0;
    return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

}  // namespace tunewright::api
