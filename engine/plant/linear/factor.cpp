#include "engine/plant/linear/factor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/number_text.h"
#include "engine/numerics/linear_algebra.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

Error invalid(const std::string& field, const std::string& message) {
    return {ErrorKind::invalid_argument, "plant/" + field, message};
}

/// A value that the user gave, with the digits that people give.
std::string as_given(double value) { return text(value, 6); }

std::optional<Error> check_finite(const char* field, double value) {
    if (std::isfinite(value)) return std::nullopt;
    return invalid(field, std::string(field) + " must be a finite number.");
}

std::optional<Error> check_gain(double K) {
    if (auto error = check_finite("K", K)) return error;
    if (K == 0) return invalid("K", "K must not be 0: with K = 0 the input cannot move the output.");
    return std::nullopt;
}

std::optional<Error> check_all(const char* field, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            return invalid(field + ("/" + std::to_string(i)), "Every coefficient must be a finite number.");
    return std::nullopt;
}

/// K/(T s + 1) in factors: T = 0 leaves a gain.
void add_lag(Factors& factors, double T) {
    if (T == 0) return;
    factors.gain /= T;
    factors.poles.emplace_back(-1 / T);
}

void add_pair(std::vector<Complex>& list, Complex value) {
    list.push_back({value.real(), std::abs(value.imag())});
    list.push_back({value.real(), -std::abs(value.imag())});
}

Expected<Factors> factor_of(const Fopdt& p) {
    if (auto error = check_gain(p.K)) return *error;
    if (auto error = check_finite("T", p.T)) return *error;
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    add_lag(factors, p.T);
    return factors;
}

Expected<Factors> factor_of(const Sopdt& p) {
    if (auto error = check_gain(p.K)) return *error;
    if (auto error = check_finite("T1", p.T1)) return *error;
    if (auto error = check_finite("T2", p.T2)) return *error;
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    add_lag(factors, p.T1);
    add_lag(factors, p.T2);
    return factors;
}

Expected<Factors> factor_of(const OscillatorySopdt& p) {
    if (auto error = check_gain(p.K)) return *error;
    if (auto error = check_finite("T", p.T)) return *error;
    if (auto error = check_finite("zeta", p.zeta)) return *error;
    if (p.T < 0)
        return invalid(
            "T", "T is " + as_given(p.T) + "; with zeta it must be >= 0 (a negative zeta makes the plant unstable).");
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    if (p.T == 0) return factors;
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
    if (auto error = check_gain(p.K)) return *error;
    if (auto error = check_finite("T", p.T)) return *error;
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
    if (p.num.empty())
        return invalid("num", "num is empty; give its coefficients in descending powers of s, e.g. [1].");
    if (p.den.empty())
        return invalid("den", "den is empty; give its coefficients in descending powers of s, e.g. [10, 1].");
    if (auto error = check_all("num", p.num)) return *error;
    if (auto error = check_all("den", p.den)) return *error;
    std::vector<double> num = p.num, den = p.den;
    const int zeros_at_origin = trim(num), poles_at_origin = trim(den);
    if (num.empty()) return invalid("num", "num is 0; the input must be able to move the output.");
    if (den.empty()) return invalid("den", "den is 0; give at least one coefficient that is not 0.");
    const int excess = static_cast<int>(den.size()) + poles_at_origin - static_cast<int>(num.size()) - zeros_at_origin;
    if (excess < 0)
        return invalid("num", "The plant is improper: the degree of num is higher than that of den by " +
                                  std::to_string(-excess) + ". Add the missing lags to den.");
    Factors factors{
        .gain = num[0] / den[0], .integrators = poles_at_origin - zeros_at_origin, .zeros = {}, .poles = {}};
    factors.zeros = polynomial_roots(num);
    factors.poles = polynomial_roots(den);
    return factors;
}

/// Conjugate pairs as neighbours; the origin counted apart. Error text if a complex value has no partner.
std::optional<std::string> sort_pairs(const std::vector<Complex>& given, std::vector<Complex>& sorted, int& at_origin) {
    std::vector<Complex> negative;
    for (const Complex value : given) {
        if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) return "Every value must be a finite number.";
        if (value == 0.0) {
            ++at_origin;
        } else if (value.imag() == 0) {
            sorted.push_back(value);
        } else if (value.imag() < 0) {
            negative.push_back(value);
        }
    }
    for (const Complex value : given) {
        if (!(value.imag() > 0)) continue;
        const auto partner = std::find_if(negative.begin(), negative.end(), [&](Complex other) {
            return std::abs(std::conj(other) - value) <= 1e-9 * std::abs(value);
        });
        if (partner == negative.end())
            return "Complex values come in conjugate pairs; [" + as_given(value.real()) + ", " +
                   as_given(value.imag()) + "] has no partner.";
        negative.erase(partner);
        add_pair(sorted, value);
    }
    if (!negative.empty())
        return "Complex values come in conjugate pairs; [" + as_given(negative[0].real()) + ", " +
               as_given(negative[0].imag()) + "] has no partner.";
    return std::nullopt;
}

Expected<Factors> factor_of(const Zpk& p) {
    if (auto error = check_gain(p.K)) return *error;
    if (p.zeros.size() > p.poles.size())
        return invalid("zeros", "The plant is improper: " + std::to_string(p.zeros.size()) + " zeros and " +
                                    std::to_string(p.poles.size()) +
                                    " poles; it needs at least as many poles as zeros.");
    Factors factors{.gain = p.K, .integrators = 0, .zeros = {}, .poles = {}};
    int zeros_at_origin = 0, poles_at_origin = 0;
    if (auto message = sort_pairs(p.zeros, factors.zeros, zeros_at_origin)) return invalid("zeros", *message);
    if (auto message = sort_pairs(p.poles, factors.poles, poles_at_origin)) return invalid("poles", *message);
    factors.integrators = poles_at_origin - zeros_at_origin;
    return factors;
}

std::optional<Error> check_shapes(const StateSpace& p) {
    const auto n = p.A.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (p.A[i].size() != n)
            return invalid("A/" + std::to_string(i), "A must be square: it has " + std::to_string(n) +
                                                         " rows, and row " + std::to_string(i) + " has " +
                                                         std::to_string(p.A[i].size()) + " entries.");
        if (auto error = check_all(("A/" + std::to_string(i)).c_str(), p.A[i])) return error;
    }
    if (p.B.size() != n)
        return invalid(
            "B", "B must have one entry a state: " + std::to_string(n) + ", not " + std::to_string(p.B.size()) + ".");
    if (p.C.size() != n)
        return invalid(
            "C", "C must have one entry a state: " + std::to_string(n) + ", not " + std::to_string(p.C.size()) + ".");
    if (auto error = check_all("B", p.B)) return error;
    if (auto error = check_all("C", p.C)) return error;
    return check_finite("D", p.D);
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
    if (auto error = check_shapes(p)) return *error;
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
    const double L = dead_time(plant);
    if (auto error = check_finite("L", L)) return *error;
    if (L < 0) return invalid("L", "L is " + as_given(L) + "; a dead time must be >= 0.");
    return std::visit([](const auto& p) { return factor_of(p); }, plant);
}

}  // namespace tunewright
