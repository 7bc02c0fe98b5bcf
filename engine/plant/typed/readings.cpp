#include "engine/plant/typed/readings.h"

#include <charconv>
#include <string>

namespace tunewright::typed {
namespace {

struct UnitName {
    std::string_view name;
    double seconds;
};

constexpr UnitName kUnits[] = {{"us", 1e-6},    {"ms", 1e-3},   {"millis", 1e-3}, {"sec", 1},     {"secs", 1},
                               {"second", 1},   {"seconds", 1}, {"min", 60},      {"mins", 60},   {"minute", 60},
                               {"minutes", 60}, {"h", 3600},    {"hr", 3600},     {"hrs", 3600},  {"hour", 3600},
                               {"hours", 3600}, {"d", 86400},   {"day", 86400},   {"days", 86400}};

bool is_plain(const std::string& digits) { return digits.find_first_not_of("0123456789") == std::string::npos; }

bool is_number(const Word& word) { return word.kind == Word::Kind::number; }

/// True if the number at the cursor, a comma and the next number are written without a blank.
bool joined_by_comma(const Cursor& cursor, std::size_t ahead) {
    const Word &comma = cursor.peek(ahead + 1), &next = cursor.peek(ahead + 2);
    return Cursor::is(comma, ",") && !comma.after_blank && is_number(next) && !next.after_blank &&
           is_plain(cursor.peek(ahead).text);
}

bool imaginary(const Word& word) {
    return word.kind == Word::Kind::name && !word.after_blank && (word.text == "i" || word.text == "j");
}

bool skip_imaginary(Cursor& cursor) {
    if (cursor.at("*") && imaginary(cursor.peek(1))) cursor.advance();
    if (!imaginary(cursor.now())) return false;
    cursor.advance();
    return true;
}

/// True if a sign at the cursor continues the root before it.
bool goes_on(const Cursor& cursor) {
    if (cursor.at("+-")) return true;
    if (!cursor.at("+") && !cursor.at("-")) return false;
    return !cursor.now().after_blank || cursor.peek(1).after_blank;
}

/// |Im| with its j; the cursor is after the sign.
double read_imaginary_part(Cursor& cursor, Commas commas) {
    double size = 1;
    const int position = cursor.now().position;
    if (cursor.at_number()) {
        size = read_number(cursor, commas);
        if (!skip_imaginary(cursor)) cursor.fail(position, "an imaginary part ends in i or j, as in -3+4i.");
    } else if (cursor.at_name() && (cursor.now().text == "i" || cursor.now().text == "j")) {
        cursor.advance();
    } else {
        cursor.unexpected("an imaginary part such as 4i");
    }
    return size;
}

void read_root(Cursor& cursor, Commas commas, std::vector<std::complex<double>>& roots) {
    const bool pair_of_axis = cursor.skip("+-");
    const double sign = cursor.skip("-") ? -1 : 1;
    if (sign > 0) cursor.skip("+");
    if (cursor.at_name() && (cursor.now().text == "i" || cursor.now().text == "j")) {
        cursor.advance();
        roots.emplace_back(0, sign);
        if (pair_of_axis) roots.emplace_back(0, -1);
        return;
    }
    if (!cursor.at_number()) return cursor.unexpected("a number such as -1 or -3+4i");
    double value = sign * read_number(cursor, commas);
    if (skip_imaginary(cursor)) {
        roots.emplace_back(0, value);
        if (pair_of_axis) roots.emplace_back(0, -value);
        return;
    }
    if (pair_of_axis)
        return cursor.fail(cursor.now().position,
                           "± must be followed by an imaginary part, such as "
                           "±4i.");
    if (cursor.at("/") && is_number(cursor.peek(1))) {
        cursor.advance();
        value /= read_number(cursor, commas);
    }
    if (!goes_on(cursor)) return roots.emplace_back(value, 0), void();
    const bool pair = cursor.at("+-"), minus = cursor.at("-");
    cursor.advance();
    const double im = read_imaginary_part(cursor, commas);
    roots.emplace_back(value, minus ? -im : im);
    if (pair) roots.emplace_back(value, -im);
}

bool begins_root(const Cursor& cursor) {
    return cursor.at_number() || cursor.at("-") || cursor.at("+") || cursor.at("+-") ||
           (cursor.at_name() && (cursor.now().text == "i" || cursor.now().text == "j"));
}

/// Reads roots up to the closing bracket, or without brackets up to the first word that cannot be a root.
void read_root_list(Cursor& cursor, Commas commas, std::vector<std::complex<double>>& roots) {
    while (!cursor.failed() && begins_root(cursor)) {
        read_root(cursor, commas, roots);
        const bool another =
            begins_root(cursor) || ((cursor.at(",") || cursor.at(";")) && [&] {
                const Word& next = cursor.peek(1);
                return is_number(next) || Cursor::is(next, "-") || Cursor::is(next, "+") || Cursor::is(next, "+-");
            }());
        if (!another) break;
        if (cursor.at(",") || cursor.at(";")) cursor.advance();
    }
}

}  // namespace

std::optional<double> seconds_of_unit(std::string_view name) {
    for (const UnitName& unit : kUnits)
        if (unit.name == name) return unit.seconds;
    return std::nullopt;
}

double in_own_time(double value, double unit, double own) {
    return unit >= own ? value * (unit / own) : value / (own / unit);
}

double read_number(Cursor& cursor, Commas commas) {
    const Word word = cursor.now();
    if (commas == Commas::separate || !joined_by_comma(cursor, 0)) {
        cursor.advance();
        return word.number;
    }
    const Word fraction = cursor.peek(2);
    const bool several = joined_by_comma(cursor, 2);
    const bool whole = fraction.text.find('.') == std::string::npos;
    if (commas == Commas::refused || several || !whole) {
        const std::string both = word.text + "," + fraction.text;
        cursor.fail(word.position, both + " may be one number or two; write " + word.text + "." + fraction.text +
                                       " for one, or a blank after the comma for two.");
        return 0;
    }
    const std::string joined = word.text + "." + fraction.text;
    constexpr std::size_t kThousandsDigits = 3;  // digits between separators of thousands
    if (fraction.text.size() == kThousandsDigits && word.text.size() <= kThousandsDigits && word.text.front() != '0') {
        cursor.fail(word.position, word.text + "," + fraction.text + " may be " + joined + " or " + word.text +
                                       fraction.text + "; write it with a decimal point, or without a separator.");
        return 0;
    }
    double value = 0;
    const auto [end, problem] = std::from_chars(joined.data(), joined.data() + joined.size(), value);
    if (problem != std::errc{} || end != joined.data() + joined.size())
        cursor.fail(word.position, joined + " cannot be read as a number.");
    for (int i = 0; i < 3; ++i) cursor.advance();
    return value;
}

double read_value(Cursor& cursor, Commas commas) {
    const double sign = cursor.skip("-") ? -1 : 1;
    if (sign > 0) cursor.skip("+");
    if (!cursor.at_number()) {
        cursor.unexpected("a number");
        return 0;
    }
    double value = sign * read_number(cursor, commas);
    while ((cursor.at("*") || cursor.at("/") || cursor.at("^")) && is_number(cursor.peek(1)) && !cursor.failed()) {
        if (cursor.at("^")) {
            cursor.fail(cursor.now().position, "write this number without an exponent.");
            return 0;
        }
        const bool divided = cursor.at("/");
        cursor.advance();
        const double other = read_number(cursor, commas);
        value = divided ? value / other : value * other;
    }
    return value;
}

std::vector<std::complex<double>> read_roots(Cursor& cursor) {
    std::vector<std::complex<double>> roots;
    const Word bracket = cursor.now();
    if (!cursor.at("[")) {
        read_root_list(cursor, Commas::refused, roots);
        return roots;
    }
    cursor.open(bracket);
    cursor.advance();
    read_root_list(cursor, Commas::separate, roots);
    if (!cursor.at("]")) {
        cursor.unexpected("a number or \"]\"");
    } else {
        cursor.close();
        cursor.advance();
    }
    return roots;
}

}  // namespace tunewright::typed
