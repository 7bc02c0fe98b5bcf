#include "engine/plant/typed/parsers.h"

#include <algorithm>
#include <utility>

#include "engine/plant/linear/factor.h"
#include "engine/plant/typed/readings.h"

namespace tunewright::typed {
namespace {

bool is_polynomial_call(const std::string& name) { return name == "tf" || name == "transferfunction"; }
bool is_root_call(const std::string& name) { return name == "zpk" || name == "zerospolesgain"; }
bool is_delay_word(const std::string& name) {
    return name == "inputdelay" || name == "outputdelay" || name == "iodelay" || name == "delay";
}

void read_separator(Cursor& cursor) {
    if (!cursor.failed() && !cursor.skip(",")) cursor.unexpected("\",\" and the next argument");
}

/// What stands behind the last argument, up to the closing bracket: 0 or a delay.
double read_delay_and_end(Cursor& cursor, const Word& opened) {
    double L = 0;
    while (!cursor.failed() && cursor.skip(",")) {
        const Word word = cursor.now();
        const bool named = word.kind == Word::Kind::quoted || word.kind == Word::Kind::name;
        if (!named || !is_delay_word(lower(word.text))) {
            cursor.fail(word.position, word.kind == Word::Kind::number
                                           ? "a further number would be a sample time; the plant must be in "
                                             "continuous time."
                                           : "known here is 'InputDelay' with its value.");
            return 0;
        }
        cursor.advance();
        if (!cursor.skip("=")) read_separator(cursor);
        L += read_value(cursor, Commas::separate);
    }
    if (cursor.failed()) return 0;
    if (!cursor.at(closing(opened))) {
        cursor.unexpected(std::string("\"") + closing(opened) + "\"");
        return 0;
    }
    cursor.close();
    cursor.advance();
    return L;
}

Formula refused(Cursor& cursor, int position, const std::string& what) {
    cursor.fail(position, what);
    return {};
}

std::string order_fault() { return "the order is beyond " + std::to_string(kMaxOrder) + "."; }

Formula polynomial_call(Cursor& cursor, const Word& opened) {
    const int position = cursor.now().position;
    std::vector<double> top = read_coefficients(cursor);
    read_separator(cursor);
    const int below = cursor.now().position;
    std::vector<double> bottom = read_coefficients(cursor);
    const double L = read_delay_and_end(cursor, opened);
    if (cursor.failed()) return {};
    if (std::max(top.size(), bottom.size()) > kMaxOrder + 1) return refused(cursor, position, order_fault());
    const Formula den = of_polynomial(std::move(bottom));
    if (den.gain == 0) return refused(cursor, below, "the denominator is 0.");
    Formula out = quotient(of_polynomial(std::move(top)), den);
    out.L = L;
    return out;
}

Formula root_call(Cursor& cursor, const Word& opened) {
    const int position = cursor.now().position;
    Zpk plant;
    plant.zeros = read_roots(cursor, Commas::separate);
    read_separator(cursor);
    plant.poles = read_roots(cursor, Commas::separate);
    read_separator(cursor);
    plant.K = cursor.failed() ? 0 : read_value(cursor, Commas::separate);
    plant.L = read_delay_and_end(cursor, opened);
    if (cursor.failed()) return {};
    if (std::max(plant.zeros.size(), plant.poles.size()) > kMaxOrder) return refused(cursor, position, order_fault());
    const std::vector<Error> faults = plant_faults(plant);
    if (!faults.empty()) return refused(cursor, position, faults.front().message);
    return *formula_of(plant);
}

}  // namespace

bool is_matrix_call(const std::string& name) { return is_polynomial_call(name) || is_root_call(name); }

Formula read_matrix_call(Cursor& cursor) {
    const std::string name = lower(cursor.now().text);
    cursor.advance();
    const Word opened = cursor.now();
    cursor.open(opened);
    cursor.advance();
    return is_polynomial_call(name) ? polynomial_call(cursor, opened) : root_call(cursor, opened);
}

}  // namespace tunewright::typed
