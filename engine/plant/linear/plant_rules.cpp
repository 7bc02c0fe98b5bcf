#include "engine/plant/linear/plant_rules.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/number_text.h"

namespace tunewright {
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
    /// Of each number, at the first that is not finite.
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
                  "; the plant must be proper (degree of num <= degree of den). Coefficients stand in descending "
                  "powers of s.");
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
                         " rows; they must be equally many.");
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
