#include "engine/plant/typed/formula.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/number_text.h"

namespace tunewright::typed {
namespace {

using Complex = std::complex<double>;

Error refusal(const std::string& sentence) { return {ErrorKind::invalid_argument, "", sentence}; }

Polynomial times(const Polynomial& a, const Polynomial& b) {
    Polynomial out(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
    return out;
}

Polynomial plus(const Polynomial& a, const Polynomial& b) {
    const bool longer = a.size() >= b.size();
    Polynomial out = longer ? a : b;
    const Polynomial& other = longer ? b : a;
    const std::size_t shift = out.size() - other.size();
    for (std::size_t i = 0; i < other.size(); ++i) out[shift + i] += other[i];
    return out;
}

void append(std::vector<Polynomial>& to, const std::vector<Polynomial>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// a s^2 + b s + c, c != 0, as the lags (T1 s + 1)(T2 s + 1), or with a damping.
Plant second_order(double gain, const Polynomial& p, double L) {
    const double K = gain / p[2], a = p[0] / p[2], b = p[1] / p[2];
    double discriminant = b * b - 4 * a;
    // Coefficients are typed as decimals: a double root must be recognised despite their last digits.
    if (std::abs(discriminant) <= 8 * std::numeric_limits<double>::epsilon() * b * b) discriminant = 0;
    if (discriminant < 0) {
        const double T = std::sqrt(a);
        return OscillatorySopdt{.K = K, .T = T, .zeta = b / (2 * T), .L = L};
    }
    const double large = (b + std::copysign(std::sqrt(discriminant), b)) / 2;
    return Sopdt{.K = K, .T1 = large, .T2 = a / large, .L = L};
}

Plant two_lags(double gain, const Polynomial& p, const Polynomial& q, double L) {
    Sopdt plant{.K = gain / (p[1] * q[1]), .T1 = p[0] / p[1], .T2 = q[0] / q[1], .L = L};
    if (std::abs(plant.T1) < std::abs(plant.T2)) std::swap(plant.T1, plant.T2);
    return plant;
}

Plant transfer_function(const Formula& f) {
    TransferFunction plant{.num = expanded(f.num), .den = expanded(f.den), .L = f.L};
    for (double& c : plant.num) c *= f.gain;
    return plant;
}

/// Adds the roots of a factor of first or second degree.
void add_roots(std::vector<Complex>& roots, const Polynomial& p) {
    if (p.size() == 2) {
        roots.emplace_back(p[1] == 0 ? 0 : -p[1] / p[0]);
        return;
    }
    const double half = -p[1] / p[0] / 2, c = p[2] / p[0], discriminant = half * half - c;
    if (discriminant < 0 && discriminant < -8 * std::numeric_limits<double>::epsilon() * half * half) {
        roots.emplace_back(half, std::sqrt(-discriminant));
        roots.emplace_back(half, -std::sqrt(-discriminant));
        return;
    }
    const double large = half + std::copysign(std::sqrt(std::max(0.0, discriminant)), half);
    roots.emplace_back(large);
    roots.emplace_back(large == 0 ? 0 : c / large);
}

Plant zeros_and_poles(const Formula& f) {
    Zpk plant{.K = f.gain, .zeros = {}, .poles = {}, .L = f.L};
    for (const Polynomial& p : f.num) plant.K *= p[0], add_roots(plant.zeros, p);
    for (const Polynomial& p : f.den) plant.K /= p[0], add_roots(plant.poles, p);
    return plant;
}

/// A plant without zeros and of at most second order, if it has a type of its own.
std::optional<Plant> simple_plant(const Formula& f) {
    const std::size_t order = degree(f.den);
    if (!f.num.empty() || order > 2) return std::nullopt;
    if (order == 0) return Fopdt{.K = f.gain, .T = 0, .L = f.L};
    const Polynomial& p = f.den[0];
    if (order == 1) {
        if (p[1] == 0) return Ipdt{.K = f.gain / p[0], .L = f.L};
        return Fopdt{.K = f.gain / p[1], .T = p[0] / p[1], .L = f.L};
    }
    if (f.den.size() == 1) {
        if (p[2] != 0) return second_order(f.gain, p, f.L);
        if (p[1] != 0) return Ipdt{.K = f.gain / p[1], .L = f.L, .T = p[0] / p[1]};
        return std::nullopt;
    }
    const Polynomial& q = f.den[1];
    if (p[1] != 0 && q[1] != 0) return two_lags(f.gain, p, q, f.L);
    if (p[1] == 0 && q[1] == 0) return std::nullopt;
    const Polynomial &integrator = p[1] == 0 ? p : q, &lag = p[1] == 0 ? q : p;
    return Ipdt{.K = f.gain / (integrator[0] * lag[1]), .L = f.L, .T = lag[0] / lag[1]};
}

bool of_small_factors(const Formula& f) {
    const auto small = [](const Polynomial& p) { return p.size() <= 3; };
    return std::all_of(f.num.begin(), f.num.end(), small) && std::all_of(f.den.begin(), f.den.end(), small) &&
           (f.num.size() > 1 || f.den.size() > 1) && degree(f.den) > 2;
}

bool finite(const Formula& f) {
    const auto all = [](const std::vector<Polynomial>& factors) {
        return std::all_of(factors.begin(), factors.end(), [](const Polynomial& p) {
            return std::all_of(p.begin(), p.end(), [](double c) { return std::isfinite(c); });
        });
    };
    return std::isfinite(f.gain) && std::isfinite(f.L) && all(f.num) && all(f.den);
}

Formula quotient_of(double gain, std::vector<Polynomial> num, std::vector<Polynomial> den, double L) {
    Formula out{.gain = gain, .num = {}, .den = {}, .L = L};
    for (Polynomial& p : num) out = product(std::move(out), of_polynomial(std::move(p)));
    for (Polynomial& p : den) out = quotient(std::move(out), of_polynomial(std::move(p)));
    return out;
}

/// s - r, or (s - r)(s - r*) if the next root is the conjugate.
std::vector<Polynomial> root_factors(const std::vector<Complex>& roots) {
    std::vector<Polynomial> out;
    std::vector<bool> used(roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
        if (used[i]) continue;
        const Complex r = roots[i];
        if (r.imag() == 0) {
            out.push_back({1, r.real() == 0 ? 0 : -r.real()});
            continue;
        }
        // Computed conjugates may differ in the last digits: the partner is the nearest root with the other sign.
        std::size_t partner = roots.size();
        for (std::size_t j = i + 1; j < roots.size(); ++j)
            if (!used[j] && (partner == roots.size() ||
                             std::abs(roots[j] - std::conj(r)) < std::abs(roots[partner] - std::conj(r))))
                partner = j;
        if (partner < roots.size()) used[partner] = true;
        out.push_back({1, -2 * r.real(), std::norm(r)});
    }
    return out;
}

Formula formula(const Fopdt& p) { return quotient_of(p.K, {}, {{p.T, 1}}, p.L); }
Formula formula(const Sopdt& p) { return quotient_of(p.K, {}, {{p.T1, 1}, {p.T2, 1}}, p.L); }
Formula formula(const OscillatorySopdt& p) { return quotient_of(p.K, {}, {{p.T * p.T, 2 * p.zeta * p.T, 1}}, p.L); }
Formula formula(const Ipdt& p) { return quotient_of(p.K, {}, {{1, 0}, {p.T, 1}}, p.L); }
Formula formula(const TransferFunction& p) { return quotient_of(1, {p.num}, {p.den}, p.L); }
Formula formula(const Zpk& p) { return quotient_of(p.K, root_factors(p.zeros), root_factors(p.poles), p.L); }
Error formula(const StateSpace&) { return refusal("a state space has no formula in s."); }

}  // namespace

std::size_t degree(const std::vector<Polynomial>& factors) {
    std::size_t sum = 0;
    for (const Polynomial& p : factors) sum += p.size() - 1;
    return sum;
}

Polynomial expanded(const std::vector<Polynomial>& factors) {
    Polynomial out = {1};
    for (const Polynomial& p : factors) out = times(out, p);
    return out;
}

Formula of_polynomial(Polynomial coefficients) {
    const auto first = std::find_if(coefficients.begin(), coefficients.end(), [](double c) { return c != 0; });
    coefficients.erase(coefficients.begin(), first);
    if (coefficients.empty()) return {.gain = 0};
    if (coefficients.size() == 1) return {.gain = coefficients[0]};
    return {.gain = 1, .num = {std::move(coefficients)}};
}

Formula product(Formula a, const Formula& b) {
    a.gain *= b.gain;
    a.L += b.L;
    append(a.num, b.num);
    append(a.den, b.den);
    return a;
}

Formula quotient(Formula a, const Formula& b) {
    a.gain /= b.gain;
    a.L -= b.L;
    append(a.num, b.den);
    append(a.den, b.num);
    return a;
}

Formula power(const Formula& a, int exponent) {
    Formula out;
    for (int i = 0; i < std::abs(exponent); ++i) out = exponent > 0 ? product(out, a) : quotient(out, a);
    return out;
}

Expected<Formula> sum(const Formula& a, const Formula& b) {
    if (a.gain == 0) return b;
    if (b.gain == 0) return a;
    if (a.L != b.L)
        return refusal("the terms of a sum have different dead times, " + text(a.L, 6) + " and " + text(b.L, 6) +
                       "; a linear plant can have only one dead time here. Approximate one of them, or omit it.");
    const auto scaled = [](const Formula& f, const std::vector<Polynomial>& others) {
        Polynomial out = times(expanded(f.num), expanded(others));
        for (double& c : out) c *= f.gain;
        return out;
    };
    const bool alike = a.den == b.den;
    const std::vector<Polynomial> none;
    Formula out = of_polynomial(plus(scaled(a, alike ? none : b.den), scaled(b, alike ? none : a.den)));
    out.den = a.den;
    if (!alike) append(out.den, b.den);
    out.L = a.L;
    return out;
}

Expected<Plant> plant_of(const Formula& f) {
    if (!finite(f)) return refusal("the numbers are too large to be computed with.");
    if (f.gain == 0) return refusal("the formula is 0, so the input would not move the measurement.");
    if (f.L < 0)
        return refusal("the formula has a dead time of -" + text(-f.L, 6) +
                       ", which is not causal; write a dead time with a minus sign, as in e^(-3s).");
    const std::size_t zeros = degree(f.num), poles = degree(f.den);
    if (zeros > poles)
        return refusal("the numerator is of degree " + std::to_string(zeros) + ", the denominator of " +
                       std::to_string(poles) + ", so the plant would be improper. Is a bracket missing?");
    if (auto plant = simple_plant(f)) return *std::move(plant);
    return of_small_factors(f) ? zeros_and_poles(f) : transfer_function(f);
}

Expected<Formula> formula_of(const Plant& plant) {
    return std::visit([](const auto& p) -> Expected<Formula> { return formula(p); }, plant);
}

}  // namespace tunewright::typed
