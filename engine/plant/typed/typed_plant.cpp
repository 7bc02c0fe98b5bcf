#include "engine/plant/typed/typed_plant.h"

#include <cmath>
#include <utility>

#include "engine/number_text.h"
#include "engine/plant/linear/factor.h"
#include "engine/plant/typed/parameter_parser.h"
#include "engine/plant/typed/program.h"
#include "engine/plant/typed/words.h"

namespace tunewright {
namespace {

using namespace typed;

Expected<TypedPlant> of_parameters(Cursor& cursor, double own_time) {
    Plant plant = read_parameters(cursor, own_time);
    if (cursor.failed()) return cursor.fault();
    const std::vector<Error> faults = plant_faults(plant);
    if (!faults.empty()) return Error{ErrorKind::invalid_argument, "", faults.front().message};
    auto formula = formula_of(plant);
    if (!formula) return formula.error();
    return TypedPlant{std::move(plant), *std::move(formula)};
}

Expected<TypedPlant> of_program(const std::vector<Statement>& statements, double own_time) {
    auto value = read_program(statements, own_time);
    if (!value) return value.error();
    if (auto* states = std::get_if<StateSpace>(&*value)) {
        const std::vector<Error> faults = plant_faults(*states);
        if (!faults.empty()) return Error{ErrorKind::invalid_argument, "", faults.front().message};
        return TypedPlant{std::move(*states), std::nullopt};
    }
    Formula& formula = std::get<Formula>(*value);
    auto plant = plant_of(formula);
    if (!plant) return plant.error();
    const std::vector<Error> faults = plant_faults(*plant);
    if (!faults.empty()) return Error{ErrorKind::invalid_argument, "", faults.front().message};
    return TypedPlant{*std::move(plant), std::move(formula)};
}

/// At most 15 digits, which a decimal keeps through a change of units: 253 does not become 252.99999999999997.
std::string as_typed(double x) { return text(x, 15); }

std::string polynomial_text(const Polynomial& p) {
    std::string out;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (p[i] == 0 && p.size() > 1) continue;
        const std::size_t power = p.size() - 1 - i;
        out += out.empty() ? (p[i] < 0 ? "-" : "") : p[i] < 0 ? " - " : " + ";
        const bool one = std::abs(p[i]) == 1 && power > 0;
        if (!one) out += as_typed(std::abs(p[i]));
        if (power > 0) out += one ? "s" : " s";
        if (power > 1) out += "^" + std::to_string(power);
    }
    return out;
}

std::string delay_text(double L) { return L == 0 ? "" : L == 1 ? "e^(-s)" : "e^(-" + as_typed(L) + " s)"; }

/// `top` e^(-Ls) divided by the factors.
std::string quotient_text(std::string top, double L, const std::vector<Polynomial>& bottom) {
    const std::string delay = delay_text(L);
    std::string out = top == "1" && !delay.empty() ? delay : delay.empty() ? std::move(top) : top + " " + delay;
    std::string below;
    for (const Polynomial& p : bottom) {
        if (p.size() == 1) continue;
        const bool bare = p.size() == 2 && p[1] == 0 && p[0] == 1;
        below += bare ? "s" : "(" + polynomial_text(p) + ")";
    }
    if (below.empty()) return out;
    const bool several = below.find(")(") != std::string::npos || (below[0] == 's' && below.size() > 1);
    return out + "/" + (several ? "(" + below + ")" : below);
}

Polynomial lag(double T) { return T == 0 ? Polynomial{1} : Polynomial{T, 1}; }

std::string text_of(const Fopdt& p) { return quotient_text(as_typed(p.K), p.L, {lag(p.T)}); }
std::string text_of(const Sopdt& p) { return quotient_text(as_typed(p.K), p.L, {lag(p.T1), lag(p.T2)}); }
std::string text_of(const Ipdt& p) { return quotient_text(as_typed(p.K), p.L, {{1, 0}, lag(p.T)}); }
std::string text_of(const OscillatorySopdt& p) {
    return "K=" + as_typed(p.K) + " T=" + as_typed(p.T) + " zeta=" + as_typed(p.zeta) +
           (p.L == 0 ? "" : " L=" + as_typed(p.L));
}

Polynomial without_leading_zeros(const std::vector<double>& coefficients) {
    std::size_t first = 0;
    while (first + 1 < coefficients.size() && coefficients[first] == 0) ++first;
    return {coefficients.begin() + static_cast<std::ptrdiff_t>(first), coefficients.end()};
}

std::string text_of(const TransferFunction& p) {
    const Polynomial num = without_leading_zeros(p.num), den = without_leading_zeros(p.den);
    if (den.size() == 1)
        return quotient_text(num.size() == 1 ? as_typed(num[0] / den[0]) : polynomial_text(num), p.L, {});
    return quotient_text(num.size() == 1 ? as_typed(num[0]) : "(" + polynomial_text(num) + ")", p.L, {den});
}

std::string roots_text(const std::vector<std::complex<double>>& roots) {
    std::string out;
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const auto r = roots[i];
        out += " ";
        if (r.imag() == 0) {
            out += as_typed(r.real());
            continue;
        }
        const bool pair = i + 1 < roots.size() && roots[i + 1] == std::conj(r);
        out += as_typed(r.real()) + (pair ? "±" : r.imag() < 0 ? "-" : "+") + as_typed(std::abs(r.imag())) + "i";
        if (pair) ++i;
    }
    return out;
}

std::string text_of(const Zpk& p) {
    return (p.zeros.empty() ? "" : "zeros" + roots_text(p.zeros) + ", ") +
           (p.poles.empty() ? "poles none" : "poles" + roots_text(p.poles)) + ", gain " + as_typed(p.K) +
           (p.L == 0 ? "" : ", delay " + as_typed(p.L));
}

/// All digits: a state space may be a small difference of large numbers.
std::string row_text(const std::vector<double>& row) {
    std::string out;
    for (const double x : row) out += (out.empty() ? "" : " ") + exact_text(x);
    return out;
}

std::string text_of(const StateSpace& p) {
    std::string A, B;
    for (const auto& row : p.A) A += (A.empty() ? "" : "; ") + row_text(row);
    for (const double x : p.B) B += (B.empty() ? "" : "; ") + exact_text(x);
    const std::string out = "ss([" + A + "], [" + B + "], [" + row_text(p.C) + "], " + exact_text(p.D) +
                            (p.L == 0 ? "" : ", 'InputDelay', " + exact_text(p.L)) + ")";
    return out.size() > kMaxLength ? "" : out;
}

}  // namespace

Expected<TypedPlant> read_plant(std::string_view text, double seconds_per_time) {
    auto words = words_of(text);
    if (!words) return words.error();
    const std::vector<Statement> statements = statements_of(*words);
    if (statements.empty())
        return Error{ErrorKind::invalid_argument, "",
                     "the text is empty; write a plant such as 2 e^(-3s)/(10s+1), K=2 T=10 L=3, or poles -1 -2, gain "
                     "3."};
    Cursor whole(*std::move(words));
    if (is_parameter_text(whole) && !is_program(statements)) return of_parameters(whole, seconds_per_time);
    Cursor value(value_of(statements[0]));
    if (statements.size() == 1 && is_parameter_text(value)) return of_parameters(value, seconds_per_time);
    return of_program(statements, seconds_per_time);
}

std::string plant_text(const Plant& plant) {
    return std::visit([](const auto& p) { return text_of(p); }, plant);
}

}  // namespace tunewright
