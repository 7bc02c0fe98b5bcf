#include "engine/plant/linear/factor.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "engine/number_text.h"
#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/resolvent.h"
#include "engine/numerics/matrix/transmission_zeros.h"
#include "engine/numerics/polynomial_roots.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kMaxCancellationDistance = 1e-8;  // of a pole's size: a zero closer than this cancels it, because both
                                                   // are computed eigenvalues
constexpr double kMinModulus = 1e-4;  // of the largest entry of A: smaller poles have an absolute, not a relative error
constexpr double kStabilityTolerance = 1e-10;  // of the largest entry of A: a real part above minus this may be 0
constexpr double kMaxOriginModulus = 1e-13;    // of the largest entry of A: a smaller eigenvalue is 0 with rounding
constexpr double kMinDivisor = 1e-300;         // stands for 0 as a divisor

Error invalid(const std::string& field, const std::string& message) {
    return {ErrorKind::invalid_argument, "plant/" + field, message};
}

/// A given value with the usual number of digits.
std::string as_given(double value) { return text(value, 6); }

/// K/(T s + 1) as factors: T = 0 leaves only a gain.
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
        // The larger root directly, the other one by their product, to avoid cancellation.
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

/// Removes leading zeros and counts trailing ones.
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

/// Makes conjugate pairs exact and neighbouring. Returns the number of roots at the origin, which are removed.
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

/// Removes poles that zeros cancel. An unstable one is an error: the loop can neither measure nor move such a mode.
std::optional<Error> cancel_hidden_modes(Factors& factors, double scale) {
    for (auto zero = factors.zeros.begin(); zero != factors.zeros.end();) {
        const auto pole = std::find_if(factors.poles.begin(), factors.poles.end(), [&](Complex p) {
            return std::abs(p - *zero) <= kMaxCancellationDistance * std::max(std::abs(p), kMinModulus * scale);
        });
        if (pole == factors.poles.end()) {
            ++zero;
            continue;
        }
        if (pole->real() >= -kStabilityTolerance * scale)
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
    const auto at_origin = [scale](Complex value) { return std::abs(value) <= kMaxOriginModulus * scale; };
    factors.integrators = static_cast<int>(std::erase_if(factors.poles, at_origin));
    factors.integrators -= static_cast<int>(std::erase_if(factors.zeros, at_origin));
    // The gain from the response at a point far from every zero and pole.
    double radius = scale;
    for (const Complex value : factors.zeros) radius = std::max(radius, std::abs(value));
    for (const Complex value : factors.poles) radius = std::max(radius, std::abs(value));
    const Complex s(2 * std::max(radius, kMinDivisor), 0);
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

namespace {

class Rules {
public:
    std::vector<Error> faults;

    void of(const Fopdt& p) {
        gain(p.K);
        finite("T", p.T);
    }
    void of(const Sopdt& p) {
        gain(p.K);
        finite("T1", p.T1);
        finite("T2", p.T2);
    }
    void of(const OscillatorySopdt& p) {
        gain(p.K);
        if (finite("T", p.T) && !(p.T > 0))
            fault("T", "T is " + text(p.T) + "; it must be > 0. A negative zeta makes the plant unstable.");
        finite("zeta", p.zeta);
    }
    void of(const Ipdt& p) {
        gain(p.K);
        finite("T", p.T);
    }
    void of(const TransferFunction& p);
    void of(const Zpk& p);
    void of(const StateSpace& p);

    void dead_time(double L) {
        if (finite("L", L) && L < 0)
            fault("L", "L is " + text(L) + "; it must be >= 0. A dead time cannot be negative.");
    }
    void uncertainty(const Uncertainty& given);

private:
    void fault(const std::string& field, const std::string& message) {
        faults.push_back({ErrorKind::invalid_argument, "plant/" + field, message});
    }
    bool finite(const std::string& field, double value) {
        if (!std::isfinite(value)) fault(field, field + " must be a finite number.");
        return std::isfinite(value);
    }
    void gain(double K) {
        if (finite("K", K) && K == 0) fault("K", "K is 0; it must not be 0. A plant with gain 0 cannot be controlled.");
    }
    /// Error at the first number that is not finite.
    bool all_finite(const std::string& field, const std::vector<double>& values) {
        const auto at = std::ranges::find_if_not(values, [](double x) { return std::isfinite(x); });
        if (at != values.end()) fault(field + "/" + std::to_string(at - values.begin()), "The number must be finite.");
        return at == values.end();
    }
    void conjugates(const std::string& field, const std::vector<std::complex<double>>& roots);
    void length(const std::string& field, std::size_t size, std::size_t states);
};

/// Degree of a polynomial in descending powers; -1 for the zero polynomial.
int degree(const std::vector<double>& polynomial) {
    const auto first = std::ranges::find_if(polynomial, [](double c) { return c != 0; });
    return static_cast<int>(polynomial.end() - first) - 1;
}

void Rules::of(const TransferFunction& p) {
    for (const auto& [field, polynomial] : {std::pair("num", &p.num), {"den", &p.den}}) {
        if (polynomial->empty())
            fault(field, std::string(field) + " is empty; give its coefficients in descending powers of s, e.g. [1].");
        if (polynomial->empty() || !all_finite(field, *polynomial)) return;
    }
    const int above = degree(p.num), below = degree(p.den);
    if (below < 0) fault("den", "den has only zeros; it must have a coefficient different from 0.");
    if (above < 0) fault("num", "num has only zeros; a plant with gain 0 cannot be controlled.");
    if (below >= 0 && above > below)
        fault("num",
              "num has degree " + std::to_string(above) + " and den degree " + std::to_string(below) +
                  "; the plant must be proper (degree of num <= degree of den). Coefficients are in descending powers "
                  "of s.");
}

void Rules::conjugates(const std::string& field, const std::vector<std::complex<double>>& roots) {
    std::vector<bool> paired(roots.size(), false);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const std::string place = field + "/" + std::to_string(i);
        if (!std::isfinite(roots[i].real()) || !std::isfinite(roots[i].imag()))
            return fault(place, "The number must be finite.");
        if (roots[i].imag() == 0 || paired[i]) continue;
        for (std::size_t j = i + 1; j < roots.size() && !paired[i]; ++j) {
            const bool partner = std::abs(std::conj(roots[j]) - roots[i]) <= kConjugateTolerance * std::abs(roots[i]);
            if (!paired[j] && partner) paired[i] = paired[j] = true;
        }
        if (!paired[i])
            return fault(place, field + "[" + std::to_string(i) + "] is [" + text(roots[i].real()) + ", " +
                                    text(roots[i].imag()) + "]; complex ones must come in conjugate pairs. Add [" +
                                    text(roots[i].real()) + ", " + text(-roots[i].imag()) + "].");
    }
}

void Rules::of(const Zpk& p) {
    gain(p.K);
    conjugates("zeros", p.zeros);
    conjugates("poles", p.poles);
    if (p.zeros.size() > p.poles.size())
        fault("zeros", "zeros has " + std::to_string(p.zeros.size()) + " elements and poles " +
                           std::to_string(p.poles.size()) + "; the plant must be proper (no more zeros than poles).");
}

void Rules::length(const std::string& field, std::size_t size, std::size_t states) {
    if (size != states)
        fault(field, field + " has " + std::to_string(size) + " numbers and A " + std::to_string(states) +
                         " rows; their numbers must be equal.");
}

void Rules::of(const StateSpace& p) {
    const std::size_t n = p.A.size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::string row = "A/" + std::to_string(i);
        if (p.A[i].size() != n)
            fault(row, "A has " + std::to_string(n) + " rows, and row " + std::to_string(i) + " has " +
                           std::to_string(p.A[i].size()) + " numbers; A must be square.");
        all_finite(row, p.A[i]);
    }
    length("B", p.B.size(), n);
    length("C", p.C.size(), n);
    all_finite("B", p.B);
    all_finite("C", p.C);
    finite("D", p.D);
}

void Rules::uncertainty(const Uncertainty& given) {
    for (const auto& [name, range] :
         {std::pair("K", &given.K), {"T", &given.T}, {"T1", &given.T1}, {"T2", &given.T2}, {"L", &given.L}}) {
        if (!*range) continue;
        const auto [low, high] = **range;
        const std::string field = std::string("uncertainty/") + name;
        if (!(low > 0))
            fault(field + "/0", "The factor is " + text(low) + "; it must be > 0.");
        else if (!(low <= 1 && high >= 1 && std::isfinite(high)))
            fault(field,
                  std::string(name) + " is [" + text(low) + ", " + text(high) +
                      "]; these are factors of the nominal value, which must lie between them: low <= 1 <= high.");
    }
}

}  // namespace

std::vector<Error> plant_faults(const Plant& plant) {
    Rules rules;
    std::visit(
        [&](const auto& p) {
            rules.of(p);
            rules.dead_time(p.L);
            rules.uncertainty(p.uncertainty);
        },
        plant);
    return std::move(rules.faults);
}

}  // namespace tunewright
