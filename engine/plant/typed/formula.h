// A plant as a quotient of factors with a dead time, as typed and as shown.
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

constexpr std::size_t kMaxOrder = 50;  ///< maximal degree of the numerator and of the denominator

struct Formula {
    double gain = 1;
    std::vector<Polynomial> num = {}, den = {};  ///< factors of degree >= 1, as written
    double L = 0;                                ///< negative: e^(+s), which a quotient may still cancel

    /// True if s occurs neither in a factor nor in a dead time.
    bool is_number() const { return num.empty() && den.empty() && L == 0; }
};

/// Degree of a product.
std::size_t degree(const std::vector<Polynomial>& factors);
Polynomial expanded(const std::vector<Polynomial>& factors);

/// A polynomial as a formula: a factor, or a gain if it has no s.
Formula of_polynomial(Polynomial coefficients);

Formula product(Formula a, const Formula& b);
/// `b` must not be 0.
Formula quotient(Formula a, const Formula& b);
/// `exponent` from -kMaxOrder to kMaxOrder; `a` must not be 0 if it is negative.
Formula power(const Formula& a, int exponent);

/// Error if the terms have different dead times: their sum is not such a formula.
Expected<Formula> sum(const Formula& a, const Formula& b);

/// The plant in its simplest type: first or second order, or integrating; for a higher order zeros and poles if it was
/// written in factors of at most second degree, else a transfer function. Errors: improper, not causal, 0, not finite.
Expected<Plant> plant_of(const Formula& formula);

/// The formula of a plant; an error for a state space, which has none.
Expected<Formula> formula_of(const Plant& plant);

}  // namespace tunewright::typed
