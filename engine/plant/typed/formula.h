// A plant as a quotient of factors with a dead time: what is typed, and what is shown as a formula.
//
//   gain num_1(s) num_2(s) ... e^(-L s) / (den_1(s) den_2(s) ...)
#pragma once

#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright::typed {

/// Coefficients in descending powers of s; the first is not 0.
using Polynomial = std::vector<double>;

constexpr std::size_t kMaxOrder = 50;  ///< degree of the numerator, and of the denominator

struct Formula {
    double gain = 1;
    std::vector<Polynomial> num = {}, den = {};  ///< each of degree >= 1, as they were written
    double L = 0;                                ///< below 0: e^(+s), which a quotient may still cancel

    /// No s in it, neither in a factor nor in a dead time.
    bool is_number() const { return num.empty() && den.empty() && L == 0; }
};

/// Degree of a product.
std::size_t degree(const std::vector<Polynomial>& factors);
Polynomial expanded(const std::vector<Polynomial>& factors);

/// Of a polynomial: a factor, or a gain where it has no s.
Formula of_polynomial(Polynomial coefficients);

Formula product(Formula a, const Formula& b);
/// `b` is not 0.
Formula quotient(Formula a, const Formula& b);
/// `exponent` from -kMaxOrder to kMaxOrder; `a` is not 0 where it is negative.
Formula power(const Formula& a, int exponent);

/// Of terms whose dead times differ there is no sum of this kind: the Error says so.
Expected<Formula> sum(const Formula& a, const Formula& b);

/// The plant of the most telling type: first or second order, integrating; of third or higher order zeros and poles
/// where it was written in factors of at most second degree; else a transfer function. Errors: improper, not causal, 0,
/// not finite.
Expected<Plant> plant_of(const Formula& formula);

/// The formula of a plant; a state space has none of this kind, and its error says so.
Expected<Formula> formula_of(const Plant& plant);

}  // namespace tunewright::typed
