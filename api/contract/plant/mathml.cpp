#include "api/contract/plant/mathml.h"

#include <cmath>
#include <cstdlib>
#include <initializer_list>

#include "api/formula/elements.h"
#include "api/json/writer.h"

namespace tunewright::api {
namespace {

using namespace mathml_elements;
using typed::Formula;
using typed::Polynomial;

/// The absolute value of a number as shown; its sign is an operator of its own. 1.2e-07 becomes a product with a power
/// of ten.
std::string mn(double value) {
    const std::string text = six_digits(std::abs(value));
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return element("mn", text);
    const int exponent = std::atoi(text.c_str() + e + 1);
    const std::string size = element("mn", std::to_string(std::abs(exponent)));
    return row(element("mn", text.substr(0, e)) + mo("·") +
               power(element("mn", "10"), exponent < 0 ? row(mo("−") + size) : size));
}

bool is_one(double value) { return six_digits(std::abs(value)) == "1"; }
std::string minus(bool negative) { return negative ? mo("−") : ""; }

std::string power_of_s(std::size_t n) {
    return n == 0 ? "" : n == 1 ? mi("s") : power(mi("s"), element("mn", std::to_string(n)));
}

/// A sum of terms in descending powers of s.
std::string polynomial(const Polynomial& p) {
    std::string out;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (p[i] == 0) continue;
        const std::size_t n = p.size() - 1 - i;
        out += out.empty() ? minus(p[i] < 0) : mo(p[i] < 0 ? "−" : "+");
        if (n == 0 || !is_one(p[i])) out += mn(p[i]);
        out += power_of_s(n);
    }
    return out;
}

bool is_s(const Polynomial& p) { return p.size() == 2 && p[0] == 1 && p[1] == 0; }

/// Equal factors are written once, with their power. A single one needs no brackets.
std::string factors(const std::vector<Polynomial>& list, bool alone) {
    std::string out;
    std::vector<bool> done(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (done[i]) continue;
        std::size_t count = 0;
        for (std::size_t j = i; j < list.size(); ++j) {
            if (list[j] != list[i]) continue;
            done[j] = true;
            ++count;
        }
        if (is_s(list[i])) {
            out += power_of_s(count);
        } else if (alone && list.size() == 1) {
            out += polynomial(list[i]);
        } else {
            const std::string factor = brackets(polynomial(list[i]));
            out += count == 1 ? factor : power(factor, element("mn", std::to_string(count)));
        }
    }
    return out;
}

std::string delay(double L) {
    if (L == 0) return "";
    return power(mi("e"), row(mo("−") + (is_one(L) ? "" : mn(L)) + mi("s")));
}

std::string right_side(const Formula& f) {
    const std::string late = delay(f.L);
    const bool gain_shown = !is_one(f.gain) || (f.num.empty() && late.empty());
    const bool alone = late.empty() && !gain_shown && !f.den.empty();
    const std::string top = (gain_shown ? mn(f.gain) : "") + factors(f.num, alone) + late;
    if (f.den.empty()) return minus(f.gain < 0) + top;
    return minus(f.gain < 0) + fraction(top, factors(f.den, true));
}

std::string matrix(const std::vector<std::vector<double>>& rows) {
    std::string inside;
    for (const auto& line : rows) {
        std::string cells;
        for (const double value : line) cells += element("mtd", row(minus(value < 0) + mn(value)));
        inside += element("mtr", cells);
    }
    return row(mo("[") + element("mtable", inside) + mo("]"));
}

/// The formula C (s I - A)^-1 B + D.
std::string right_side(const StateSpace& p) {
    std::vector<std::vector<double>> column;
    for (const double b : p.B) column.push_back({b});
    const std::string inverse =
        power(row(brackets(mi("s") + mi("I") + mo("−") + matrix(p.A))), row(mo("−") + element("mn", "1")));
    const std::string main = matrix({p.C}) + inverse + matrix(column);
    return (p.D == 0 ? main : brackets(main + mo(p.D < 0 ? "−" : "+") + mn(p.D))) + delay(p.L);
}

std::string equation(const std::string& right) { return math(row(mi("P") + brackets(mi("s")) + mo("=") + right)); }

}  // namespace

std::string mathml(const Formula& formula) { return equation(right_side(formula)); }

std::string mathml(const Plant& plant) {
    if (const auto* space = std::get_if<StateSpace>(&plant)) return equation(right_side(*space));
    return mathml(*typed::formula_of(plant));
}

}  // namespace tunewright::api
