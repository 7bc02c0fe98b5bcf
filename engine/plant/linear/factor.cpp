#include "engine/plant/linear/factor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/number_text.h"
#include "engine/numerics/linear_algebra.h"
#include "engine/plant/linear/plant_rules.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

Error invalid(const std::string& field, const std::string& message) {
    return {ErrorKind::invalid_argument, "plant/" + field, message};
}

/// A value that the user gave, with the digits that people give.
std::string as_given(double value) { return text(value, 6); }

/// K/(T s + 1) in factors: T = 0 leaves a gain.
void add_lag(Factors& factors, double T) {
    if (T == 0) return;
    factors.gain /= T;
    factors.poles.emplace_back(-1 / T);
}

void add_pair(std::vector<Complex>& list, Complex value) {
    list.emplace_back(value.real(), std::abs(value.imag()));
    list.emplace_back(value.real(), -std::abs(value.imag()));
}

Expected<Factors> factor_of(const Fopdt& p) {
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    add_lag(factors, p.T);
    return factors;
}

Expected<Factors> factor_of(const Sopdt& p) {
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    add_lag(factors, p.T1);
    add_lag(factors, p.T2);
    return factors;
}

Expected<Factors> factor_of(const OscillatorySopdt& p) {
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    factors.gain /= p.T * p.T;
    if (std::abs(p.zeta) >= 1) {
        // The larger root directly, the other by their product: no cancellation.
        const double large = -(p.zeta + std::copysign(std::sqrt(p.zeta * p.zeta - 1), p.zeta)) / p.T;
        factors.poles = {Complex(large), Complex(1 / (p.T * p.T) / large)};
    } else {
        add_pair(factors.poles, Complex(-p.zeta, std::sqrt(1 - p.zeta * p.zeta)) / p.T);
    }
    return factors;
}

Expected<Factors> factor_of(const Ipdt& p) {
    Factors factors{.gain = p.K, .integrators = 1, .zeros = {}, .poles = {}};
    add_lag(factors, p.T);
    return factors;
}

/// Drops leading zeros and counts trailing ones.
int trim(std::vector<double>& coefficients) {
    const auto first = std::find_if(coefficients.begin(), coefficients.end(), [](double c) { return c != 0; });
    coefficients.erase(coefficients.begin(), first);
    int trailing = 0;
    while (!coefficients.empty() && coefficients.back() == 0) {
        coefficients.pop_back();
        ++trailing;
    }
    return trailing;
}

Expected<Factors> factor_of(const TransferFunction& p) {
    std::vector<double> num = p.num, den = p.den;
    const int zeros_at_origin = trim(num), poles_at_origin = trim(den);
    Factors factors{
        .gain = num[0] / den[0], .integrators = poles_at_origin - zeros_at_origin, .zeros = {}, .poles = {}};
    factors.zeros = polynomial_roots(num);
    factors.poles = polynomial_roots(den);
    return factors;
}

/// Conjugate pairs as neighbours, made exact; returns how many lie at the origin, which are left out.
int sort_pairs(const std::vector<Complex>& given, std::vector<Complex>& sorted) {
    int at_origin = 0;
    for (const Complex value : given) {
        if (value == 0.0)
            ++at_origin;
        else if (value.imag() == 0)
            sorted.push_back(value);
    }
    for (const Complex value : given)
        if (value.imag() > 0) add_pair(sorted, value);
    return at_origin;
}

Expected<Factors> factor_of(const Zpk& p) {
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    const int zeros_at_origin = sort_pairs(p.zeros, factors.zeros),
              poles_at_origin = sort_pairs(p.poles, factors.poles);
    factors.integrators = poles_at_origin - zeros_at_origin;
    return factors;
}

/// Removes poles that zeros cancel. An unstable one is a mode that the loop cannot see or move.
std::optional<Error> cancel_hidden_modes(Factors& factors, double scale) {
    for (auto zero = factors.zeros.begin(); zero != factors.zeros.end();) {
        const auto pole = std::find_if(factors.poles.begin(), factors.poles.end(), [&](Complex p) {
            return std::abs(p - *zero) <= 1e-8 * std::max(std::abs(p), 1e-4 * scale);
        });
        if (pole == factors.poles.end()) {
            ++zero;
            continue;
        }
        if (pole->real() >= -1e-10 * scale)
            return Error{ErrorKind::unsupported, "plant/A",
                         "The mode at s = " + as_given(pole->real()) +
                             (pole->imag() != 0 ? " + " + as_given(pole->imag()) + "j" : "") +
                             " is not stable and input or output cannot reach it, so no controller can stabilise it. "
                             "Remove it from the model if it is not real."};
        factors.poles.erase(pole);
        zero = factors.zeros.erase(zero);
    }
    return std::nullopt;
}

Expected<Factors> factor_of(const StateSpace& p) {
    const int n = static_cast<int>(p.A.size());
    std::vector<double> A;
    double scale = 0;
    for (const auto& row : p.A)
        for (const double a : row) {
            A.push_back(a);
            scale = std::max(scale, std::abs(a));
        }
    const auto zeros = transmission_zeros(A, p.B, p.C, p.D, n);
    if (!zeros)
        return invalid("C", "The transfer function of this state space is 0: the input cannot move the output.");
    Factors factors{.gain = 0, .integrators = 0, .zeros = *zeros, .poles = eigenvalues(A, n)};
    if (auto error = cancel_hidden_modes(factors, scale)) return *error;
    const auto at_origin = [scale](Complex value) { return std::abs(value) <= 1e-13 * scale; };
    factors.integrators = static_cast<int>(std::erase_if(factors.poles, at_origin));
    factors.integrators -= static_cast<int>(std::erase_if(factors.zeros, at_origin));
    // The gain from the response at a point away from every zero and pole.
    double radius = scale;
    for (const Complex value : factors.zeros) radius = std::max(radius, std::abs(value));
    for (const Complex value : factors.poles) radius = std::max(radius, std::abs(value));
    const Complex s(2 * std::max(radius, 1e-300), 0);
    Complex product = std::pow(s, -factors.integrators);
    for (const Complex zero : factors.zeros) product *= s - zero;
    for (const Complex pole : factors.poles) product /= s - pole;
    factors.gain = (resolvent_response(A, p.B, p.C, p.D, n, s) / product).real();
    return factors;
}

}  // namespace

Expected<Factors> factor(const Plant& plant) {
    if (const auto faults = plant_faults(plant); !faults.empty()) return faults.front();
    return std::visit([](const auto& p) { return factor_of(p); }, plant);
}

}  // namespace tunewright
