#include "engine/plant/typed/lists.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/plant/expression/tokens.h"
#include "engine/plant/typed/readings.h"

namespace tunewright::typed {
namespace {

using Complex = std::complex<double>;

constexpr int kMaxListDepth = 30;

bool is_list_function(const Word& name, const Word& next) {
    const std::string word = lower(name.text);
    return name.kind == Word::Kind::name && Cursor::is(next, "(") &&
           (word == "conv" || word == "convolve" || word == "polymul" || word == "array");
}

/// True for the type of the elements of a list in Julia, as in Float64[].
bool is_element_type(const Word& name, const Word& next) {
    return (is_name(name, "Float64") || is_name(name, "ComplexF64") || is_name(name, "Int64")) &&
           Cursor::is(next, "[") && !next.after_blank;
}

bool is_imaginary_unit(const Word& word) { return is_name(word, "i") || is_name(word, "j") || is_name(word, "im"); }

/// Real numbers stay exact: a complex division would round them twice.
Complex quotient_of(Complex a, Complex b) {
    if (a.imag() == 0 && b.imag() == 0) return a.real() / b.real();
    return a / b;
}
Complex product_of(Complex a, Complex b) {
    if (a.imag() == 0 && b.imag() == 0) return a.real() * b.real();
    return a * b;
}

class MatrixReader {
public:
    MatrixReader(Cursor& cursor, const Names& names) : cursor_(cursor), names_(names) {}

    Matrix read() {
        const Level level(depth_);
        if (depth_ > kMaxListDepth) {
            cursor_.fail(cursor_.now().position,
                         "brackets are nested more than " + std::to_string(kMaxListDepth) + " deep.");
            return {{}};
        }
        if (is_element_type(cursor_.now(), cursor_.peek(1))) cursor_.advance();
        if (is_list_function(cursor_.now(), cursor_.peek(1))) return function();
        if (cursor_.at("[") || cursor_.at("{")) return bracketed();
        if (const Matrix* named = named_list()) return cursor_.advance(), *named;
        return {{sum()}};
    }

private:
    struct Level {
        explicit Level(int& depth) : depth_(depth) { ++depth_; }
        ~Level() { --depth_; }
        int& depth_;
    };

    const Matrix* named_list() const {
        const auto found = cursor_.at_name() ? names_.find(cursor_.now().text) : names_.end();
        return found != names_.end() && found->second.matrix ? &*found->second.matrix : nullptr;
    }

    Word opened() {
        const Word bracket = cursor_.now();
        cursor_.open(bracket);
        cursor_.advance();
        return bracket;
    }
    void closed(const Word& bracket, const std::string& wanted) {
        if (cursor_.failed()) return;
        if (!cursor_.at(closing(bracket))) return cursor_.unexpected(wanted + " or \"" + closing(bracket) + "\"");
        cursor_.close();
        cursor_.advance();
    }

    Matrix bracketed() {
        const bool outer = std::exchange(in_list_, true);
        const Word bracket = opened();
        Matrix rows(1);
        bool nested = false;
        while (!cursor_.failed() && !closes(cursor_.now()) && !cursor_.at_end()) {
            if (cursor_.at(";") || (cursor_.now().after_line && !rows.back().empty() && !after_comma_)) {
                cursor_.skip(";");
                if (!rows.back().empty()) rows.emplace_back();
            } else if (cursor_.at("[") || cursor_.at("{")) {
                add_nested(rows, nested);
                nested = true;
            } else {
                element(rows.back());
            }
            after_comma_ = !cursor_.failed() && cursor_.skip(",");
        }
        after_comma_ = false;
        if (rows.back().empty() && rows.size() > 1) rows.pop_back();
        closed(bracket, "a number");
        in_list_ = outer;
        return !cursor_.failed() && cursor_.skip("'") ? transposed(checked(std::move(rows), bracket)) : rows;
    }

    // A list in a list is a row of it; a list of one list is that list.
    void add_nested(Matrix& rows, bool more) {
        const Word bracket = cursor_.now();
        Matrix inner = read();
        if (!rows.back().empty() && !more)
            return cursor_.fail(bracket.position, "a list has either numbers or rows; write [[1, 2], [3, 4]].");
        if (rows.back().empty()) rows.pop_back();
        rows.insert(rows.end(), inner.begin(), inner.end());
    }

    Matrix checked(Matrix rows, const Word& bracket) {
        const bool equal = std::ranges::all_of(rows, [&](const auto& row) { return row.size() == rows[0].size(); });
        if (equal) return rows;
        cursor_.fail(bracket.position, "the rows of this matrix have different lengths.");
        return {{}};
    }

    Matrix function() {
        const std::string name = lower(cursor_.now().text);
        cursor_.advance();
        const Word bracket = opened();
        Matrix first = read();
        if (name != "array") {
            if (!cursor_.failed() && !cursor_.skip(",")) cursor_.unexpected("\",\" and the second list");
            first = convolved(flat(std::move(first), bracket), flat(read(), bracket));
        }
        closed(bracket, "an operator");
        return first;
    }

    std::vector<Complex> flat(Matrix rows, const Word& bracket) {
        if (rows.size() == 1 && !rows[0].empty()) return rows[0];
        cursor_.fail(bracket.position, "conv needs two lists of coefficients, such as conv([10 1],[2 1]).");
        return {0};
    }
    static Matrix convolved(const std::vector<Complex>& a, const std::vector<Complex>& b) {
        std::vector<Complex> out(a.size() + b.size() - 1);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += product_of(a[i], b[j]);
        return {out};
    }

    void element(std::vector<Complex>& row) {
        if (cursor_.skip("+-")) {
            const Complex root = product();
            row.insert(row.end(), {root, std::conj(root)});
            return;
        }
        Complex value = sum();
        if (cursor_.failed() || !cursor_.skip("+-")) return row.push_back(value), void();
        const Complex part = product();
        row.insert(row.end(), {value + part, value - part});
    }

    /// True if a sign at the cursor continues the number before it.
    bool goes_on() const {
        if (!cursor_.at("+") && !cursor_.at("-")) return false;
        return !in_list_ || !cursor_.now().after_blank || cursor_.peek(1).after_blank;
    }

    Complex sum() {
        Complex value = product();
        while (!cursor_.failed() && goes_on()) {
            const bool minus = cursor_.at("-");
            cursor_.advance();
            const Complex other = product();
            value = minus ? value - other : value + other;
        }
        return value;
    }

    Complex product() {
        Complex value = signed_number();
        while (!cursor_.failed() && (cursor_.at("*") || cursor_.at("/"))) {
            const bool divided = cursor_.at("/");
            const int position = cursor_.now().position;
            cursor_.advance();
            const Complex other = signed_number();
            if (divided && other == 0.0) cursor_.fail(position, "this divides by 0.");
            value = divided ? quotient_of(value, other) : product_of(value, other);
        }
        return value;
    }

    Complex signed_number() {
        bool minus = false;
        while (cursor_.at("-") || cursor_.at("+")) {
            minus ^= cursor_.at("-");
            cursor_.advance();
        }
        const Complex value = power();
        // 0 - x would change the sign of an imaginary part of 0.
        return minus ? Complex(-value.real(), value.imag() == 0 ? 0 : -value.imag()) : value;
    }

    Complex power() {
        const Complex base = primary();
        if (cursor_.failed() || !cursor_.skip("^")) return base;
        const int position = cursor_.now().position;
        const bool bracket = cursor_.at("(");
        const Complex exponent = bracket ? primary() : signed_number();
        if (cursor_.failed()) return 0;
        const double n = exponent.real();
        if (exponent.imag() != 0 || n != std::floor(n) || std::abs(n) > static_cast<double>(kMaxOrder)) {
            cursor_.fail(position, "a power must be a whole number of at most 50 here.");
            return 0;
        }
        Complex out = 1;
        for (int i = 0; i < static_cast<int>(std::abs(n)); ++i) out = product_of(out, base);
        return n < 0 ? quotient_of(1, out) : out;
    }

    Complex primary() {
        if (cursor_.failed()) return 0;
        if (cursor_.at_number()) return number();
        if (cursor_.at("(")) return grouped();
        if (is_imaginary_unit(cursor_.now()) && !names_.contains(cursor_.now().text))
            return cursor_.advance(), Complex(0, 1);
        if (cursor_.at_name()) return named_number();
        cursor_.unexpected("a number");
        return 0;
    }

    Complex grouped() {
        const bool outer = std::exchange(in_list_, false);
        const Level level(depth_);
        const Word bracket = opened();
        if (depth_ > kMaxListDepth)
            cursor_.fail(bracket.position, "brackets are nested more than " + std::to_string(kMaxListDepth) + " deep.");
        const Complex value = cursor_.failed() ? 0 : sum();
        closed(bracket, "an operator");
        in_list_ = outer;
        return value;
    }

    Complex number() {
        const double value = read_number(cursor_, Commas::separate);
        if (!is_imaginary_unit(cursor_.now()) || cursor_.now().after_blank) return value;
        cursor_.advance();
        return {0, value};
    }

    Complex named_number() {
        const Word word = cursor_.now();
        const std::string name = lower(word.text);
        cursor_.advance();
        if (const auto found = names_.find(word.text); found != names_.end()) {
            if (found->second.formula && found->second.formula->is_number()) return found->second.formula->gain;
            const Matrix* list = found->second.matrix ? &*found->second.matrix : nullptr;
            if (list && list->size() == 1 && list->front().size() == 1) return list->front().front();
            cursor_.fail(word.position, quoted(word.text) + " is not a number.");
            return 0;
        }
        if (name == "inf") return std::numeric_limits<double>::infinity();
        if (word.text == "pi") return std::numbers::pi;  // PI is a kind of controller
        cursor_.fail(word.position, quoted(word.text) +
                                        " has no value here; write its number, or assign it before, as in T = 10; "
                                        "G = tf(2,[T 1]).");
        return 0;
    }

    Cursor& cursor_;
    const Names& names_;
    int depth_ = 0;
    bool in_list_ = false, after_comma_ = false;
};

}  // namespace

bool at_list(const Cursor& cursor, const Names& names) {
    if (cursor.at("[") || cursor.at("{") || is_list_function(cursor.now(), cursor.peek(1)) ||
        is_element_type(cursor.now(), cursor.peek(1)))
        return true;
    const auto found = cursor.at_name() ? names.find(cursor.now().text) : names.end();
    return found != names.end() && found->second.matrix;
}

Matrix read_matrix(Cursor& cursor, const Names& names) { return MatrixReader(cursor, names).read(); }

Matrix transposed(const Matrix& matrix) {
    Matrix out(std::max<std::size_t>(1, matrix.empty() ? 0 : matrix[0].size()));
    for (const auto& row : matrix)
        for (std::size_t i = 0; i < row.size(); ++i) out[i].push_back(row[i]);
    return out;
}

}  // namespace tunewright::typed
