
#include "engine/plant/typed/formula_parser.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/number_text.h"
#include "engine/plant/expression/tokens.h"
#include "engine/plant/typed/plant_calls.h"
#include "engine/plant/typed/readings.h"

namespace tunewright::typed {
namespace {

std::string order_fault() { return "the order is above " + std::to_string(kMaxOrder) + "."; }

constexpr int kMaxDepth = 30;

class FormulaParser {
public:
    FormulaParser(Cursor& cursor, const Names& names, double own_time)
        : cursor_(cursor), names_(names), own_time_(own_time) {}

    Formula read() {
        Formula formula = sum();
        if (!cursor_.at_end() && !cursor_.failed()) refuse_rest();
        return formula;
    }

private:
    struct Level {
        explicit Level(int& depth) : depth_(depth) { ++depth_; }
        ~Level() { --depth_; }
        int& depth_;
    };

    void refuse_rest() {
        const Word& word = cursor_.now();
        if (word.text == ")" || word.text == "]" || word.text == "}")
            return cursor_.fail(word.position, "this closing bracket has no opening one.");
        if (word.text == "=")
            return cursor_.fail(word.position,
                                "\"=\" is not allowed in a formula; write only the "
                                "formula.");
        cursor_.unexpected("an operator or the end");
    }

    Formula checked(Formula formula, int position) {
        if (degree(formula.num) > kMaxOrder || degree(formula.den) > kMaxOrder) cursor_.fail(position, order_fault());
        return cursor_.failed() ? Formula() : formula;
    }

    Formula sum() {
        const Level level(depth_);
        if (depth_ > kMaxDepth) {
            cursor_.fail(cursor_.now().position,
                         "brackets are nested more than " + std::to_string(kMaxDepth) + " deep.");
            return {};
        }
        Formula left = product_of_factors();
        while (cursor_.at("+") || cursor_.at("-")) {
            const bool minus = cursor_.at("-");
            const int position = cursor_.now().position;
            cursor_.advance();
            Formula right = product_of_factors();
            if (cursor_.failed()) return {};
            if (minus) right.gain = -right.gain;
            if (std::max(degree(left.num) + degree(right.den), degree(right.num) + degree(left.den)) > kMaxOrder) {
                cursor_.fail(position, order_fault());
                return {};
            }
            auto added = typed::sum(left, right);
            if (!added) {
                cursor_.fail(position, added.error().message);
                return {};
            }
            left = checked(*std::move(added), position);
        }
        return left;
    }

    bool at_dead_time() const {
        const Word& word = cursor_.now();
        return word.kind == Word::Kind::name && (word.text == "exp" || (word.text == "e" && power_follows()));
    }
    bool power_follows() const { return Cursor::is(cursor_.peek(1), "^"); }
    bool begins_factor() const { return opens(cursor_.now()) || cursor_.at_name(); }

    Formula product_of_factors() {
        Formula left = signed_factor();
        bool divided = false;
        while (!cursor_.failed()) {
            const int position = cursor_.now().position;
            if (cursor_.skip("*")) {
                left = product(std::move(left), signed_factor());
                divided = false;
            } else if (cursor_.skip("/")) {
                const Formula right = signed_factor();
                if (!cursor_.failed() && right.gain == 0) cursor_.fail(position, "this divides by 0.");
                if (!cursor_.failed()) left = quotient(std::move(left), right);
                divided = true;
            } else if (begins_factor()) {
                if (divided && !at_dead_time()) {
                    cursor_.fail(position,
                                 "the division before this is ambiguous: a/b c may be a/(b c) or (a/b) c. Add "
                                 "brackets.");
                    return {};
                }
                left = product(std::move(left), factor());
            } else {
                break;
            }
            left = checked(std::move(left), position);
        }
        return left;
    }

    Formula signed_factor() {
        bool minus = false;
        while (cursor_.at("-") || cursor_.at("+")) {
            minus ^= cursor_.at("-");
            cursor_.advance();
        }
        Formula out = factor();
        if (minus) out.gain = -out.gain;
        return out;
    }

    Formula factor() {
        const int position = cursor_.now().position;
        const Formula base = primary();
        if (!cursor_.at("^")) return base;
        cursor_.advance();
        const std::optional<int> n = exponent();
        if (!n) return {};
        const std::size_t size = std::max(degree(base.num), degree(base.den)) * static_cast<std::size_t>(std::abs(*n));
        if (size > kMaxOrder || (base.is_number() && base.gain == 0 && *n < 0)) {
            cursor_.fail(position, size > kMaxOrder ? order_fault() : "this divides by 0.");
            return {};
        }
        if (cursor_.at("^")) cursor_.fail(cursor_.now().position, "a power of a power needs brackets.");
        return power(base, *n);
    }

    std::optional<int> exponent() {
        const int position = cursor_.now().position;
        Formula value;
        if (opens(cursor_.now())) {
            value = bracket();
        } else {
            const double sign = cursor_.skip("-") ? -1 : 1;
            if (sign > 0) cursor_.skip("+");
            if (!cursor_.at_number()) {
                cursor_.unexpected("a whole number");
                return std::nullopt;
            }
            value.gain = sign * read_number(cursor_, Commas::decimal);
        }
        if (cursor_.failed()) return std::nullopt;
        const bool whole =
            value.is_number() && std::abs(value.gain) <= kMaxOrder && value.gain == std::floor(value.gain);
        if (!whole) {
            cursor_.fail(position, "a power must be a whole number of at most 50 here (a dead time is e^(-3s)).");
            return std::nullopt;
        }
        return static_cast<int>(value.gain);
    }

    Formula bracket() {
        const Word opened = cursor_.now();
        cursor_.open(opened);
        cursor_.advance();
        Formula inside = sum();
        if (cursor_.failed()) return {};
        if (!cursor_.at(closing(opened))) {
            cursor_.unexpected(std::string("an operator or \"") + closing(opened) + "\"");
            return {};
        }
        cursor_.close();
        cursor_.advance();
        return inside;
    }

    Formula primary() {
        if (cursor_.failed()) return {};
        if (cursor_.at_number()) return number();
        if (opens(cursor_.now())) return bracket();
        if (cursor_.at_name()) return name();
        cursor_.unexpected("a number, s or a bracket");
        return {};
    }

    Formula number() {
        const Word word = cursor_.now();
        const Word& next = cursor_.peek(1);
        const std::size_t small = word.text.find_first_of("eE");
        if (small != std::string::npos && word.text[small + 1] == '-' && next.text == "s" && !next.after_blank) {
            cursor_.fail(word.position, word.text + "s may be " + exact_text(word.number) + " s or " +
                                            word.text.substr(0, small) + " e^(" + word.text.substr(small + 1) +
                                            " s); write the one that you mean.");
            return {};
        }
        const double value = read_number(cursor_, Commas::decimal);
        if (cursor_.failed()) return {};
        const bool unit_of_time = cursor_.at_name() && !names_.contains(cursor_.now().text);
        const auto unit = unit_of_time ? seconds_of_unit(cursor_.now().text) : std::nullopt;
        return unit ? number_with_unit(value, *unit) : Formula{.gain = value};
    }

    // 10 min s: the unit belongs to the time that multiplies s.
    Formula number_with_unit(double value, double unit) {
        const Word word = cursor_.now();
        cursor_.advance();
        int times = 1;
        if (cursor_.skip("^")) times = exponent().value_or(1);
        const bool sign = Cursor::is(cursor_.now(), "*");
        const Word& s = cursor_.peek(sign ? 1 : 0);
        if (!cursor_.failed() && (s.kind != Word::Kind::name || s.text != "s" || times < 1))
            cursor_.fail(word.position,
                         "write a unit of time between its number and s, as in (10 " + word.text + " s + 1).");
        if (!cursor_.failed() && own_time_ <= 0)
            cursor_.fail(word.position,
                         "units.time is not a known unit of time; write the times without " + word.text + ".");
        if (cursor_.failed()) return {};
        if (sign) cursor_.advance();
        for (int i = 0; i < times; ++i) value = in_own_time(value, unit, own_time_);
        return product(Formula{.gain = value}, factor());
    }

    Formula name() {
        const Word word = cursor_.now();
        const std::string spelt = lower(word.text);
        if (const auto named = names_.find(word.text); named != names_.end()) return value_of(word, named->second);
        if (word.text == "s" || word.text == "S") {
            cursor_.advance();
            return {.gain = 1, .num = {{1, 0}}};
        }
        if (at_dead_time()) return dead_time();
        if (word.text == "\\frac") return fraction();
        if (at_call(cursor_) && is_formula_function(spelt)) {
            const Call call = read_call(cursor_, names_);
            return formula_of_call(call, cursor_);
        }
        if (word.text == "pi") return cursor_.advance(), Formula{.gain = std::numbers::pi};
        refuse_name(word);
        return {};
    }

    Formula value_of(const Word& word, const NamedValue& value) {
        cursor_.advance();
        if (value.formula) return *value.formula;
        const Matrix& list = value.matrix ? *value.matrix : Matrix{{}};
        if (list.size() == 1 && list[0].size() == 1 && list[0][0].imag() == 0) return {.gain = list[0][0].real()};
        cursor_.fail(word.position, quoted(word.text) + " is a list or a state space, not a factor of a formula.");
        return {};
    }

    void refuse_name(const Word& word) {
        const std::string name = quoted(word.text);
        if (is_state_space_function(lower(word.text)))
            return cursor_.fail(word.position,
                                "a state space can only be multiplied by numbers and dead times here, as in "
                                "exp(-3*s)*ss(A,B,C,D).");
        if (word.text == "e") return cursor_.fail(word.position, "e is only allowed in a dead time, as in e^(-3s).");
        if (word.text == "p" || word.text == "z" || word.text == "q")
            return cursor_.fail(word.position, name + " is not a variable here; write s, in continuous time.");
        if (seconds_of_unit(word.text))
            return cursor_.fail(word.position, name +
                                                   " is a unit of time; write it after its number, as in (10 min s + "
                                                   "1).");
        if (Cursor::is(cursor_.peek(1), "(")) return refuse_call(word, cursor_);
        cursor_.fail(word.position, name +
                                        " is unknown; a formula has numbers, s and e^(-3s). Write its value "
                                        "instead.");
    }

    Formula fraction() {
        cursor_.advance();
        if (!opens(cursor_.now())) return cursor_.unexpected("\"{\""), Formula();
        Formula top = bracket();
        if (!opens(cursor_.now())) return cursor_.unexpected("\"{\""), Formula();
        const int position = cursor_.now().position;
        const Formula bottom = bracket();
        if (!cursor_.failed() && bottom.gain == 0) cursor_.fail(position, "this divides by 0.");
        return cursor_.failed() ? Formula() : checked(quotient(std::move(top), bottom), position);
    }

    Formula dead_time() {
        const Word word = cursor_.now();
        cursor_.advance();
        if (word.text == "e") cursor_.advance();
        Formula exponent;
        if (opens(cursor_.now())) {
            exponent = bracket();
        } else if (word.text == "e") {
            exponent = bare_exponent();
        } else {
            cursor_.unexpected("\"(\"");
        }
        if (cursor_.failed()) return {};
        return dead_time_of(exponent, word.position);
    }

    /// An exponent without brackets, such as -3s: the factors up to the next sign.
    Formula bare_exponent() {
        const double sign = cursor_.skip("-") ? -1 : 1;
        if (sign > 0) cursor_.skip("+");
        if (!cursor_.at_number() && cursor_.now().text != "s") {
            cursor_.unexpected("an exponent such as (-3s)");
            return {};
        }
        Formula out = cursor_.at_number() ? number() : Formula();
        if (cursor_.at_name() && cursor_.now().text == "s") out = product(std::move(out), primary());
        out.gain *= sign;
        return out;
    }

    Formula dead_time_of(const Formula& exponent, int position) {
        const bool proportional = exponent.L == 0 && exponent.den.empty() && exponent.num.size() == 1 &&
                                  exponent.num[0].size() == 2 && exponent.num[0][1] == 0;
        if (exponent.gain == 0) return {};
        if (!proportional) {
            cursor_.fail(position, exponent.is_number()
                                       ? "the exponent has no s; write a dead time of 3 as e^(-3s), with the brackets."
                                       : "only a dead time is allowed in an exponent, as in e^(-3s).");
            return {};
        }
        return {.gain = 1, .L = -exponent.gain * exponent.num[0][0]};
    }

    Cursor& cursor_;
    const Names& names_;
    double own_time_;
    int depth_ = 0;
};

}  // namespace

Formula read_formula(Cursor& cursor, const Names& names, double own_time) {
    return FormulaParser(cursor, names, own_time).read();
}

}  // namespace tunewright::typed
