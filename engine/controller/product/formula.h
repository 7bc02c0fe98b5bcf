// Value, inverse and text of the parameters' formulas, computed from their terms.
#pragma once

#include <optional>

#include "engine/controller/product/product.h"

namespace tunewright::product {

/// Gain and times of a block's own form, in seconds and units of u per y, and the other quantities that a term may use.
struct Quantities {
    double Kp = 0;
    double Ti = std::numeric_limits<double>::infinity();
    double Td = 0;
    double Tf = 0;
    double ideal_Td = 0;
    double Sy = 1, Su = 1;
    double Ts = 1;
    double K = 1;
};

/// factor * Kp^Term::Kp * ...; not finite if the law does not determine the parameter (a ratio to a time of 0).
double value_of(const Term& term, const Quantities& quantities);

/// Solves for the quantity that gives the term this value, with the others unchanged. `exponent` is that quantity's
/// exponent in the term.
double solved(const Term& term, const Quantities& quantities, double Quantities::*unknown, double exponent,
              double value);

/// Tf of a derivative filter from its parameter, with the other quantities known, and the inverse. `clock` is dt of the
/// firmware or the sample time, in seconds.
double filter_value(const Parameter& parameter, const Quantities& quantities, double clock);
double filter_time(const Parameter& parameter, const Quantities& quantities, double clock, double value);

/// Tf of a first-order filter that, together with the Ts/2 of a plain difference, has the delay of the block's slope:
/// (M - 1) Ts/2 for M samples, Ts for four points.
double slope_filter_time(double samples, double Ts);
/// The number of samples of a slope, rounded to a whole number from 1 to a million.
int whole_samples(double samples);

}  // namespace tunewright::product
