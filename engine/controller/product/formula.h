// The formulas of parameters, read from their terms: value, inverse and text.
#pragma once

#include <optional>

#include "engine/controller/product/product.h"

namespace tunewright::product {

/// Gain and times of a block's own form, in seconds and units of u per y, and what else a term may ask for.
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

/// factor * Kp^Term::Kp * ...; not finite where the law leaves the parameter open (a ratio to a time of 0).
double value_of(const Term& term, const Quantities& quantities);

/// The quantity that makes the term this value; the others stay as they are. `exponent` is the term's of that quantity.
double solved(const Term& term, const Quantities& quantities, double Quantities::*unknown, double exponent,
              double value);

/// Tf of a derivative filter from its parameter, the other quantities known, and back. `clock` is dt of the firmware or
/// the sample time, in seconds.
double filter_value(const Parameter& parameter, const Quantities& quantities, double clock);
double filter_time(const Parameter& parameter, const Quantities& quantities, double clock, double value);

/// Tf of a first-order filter that delays a slope like the block's does: of M samples (M - 1) Ts/2, of the four points
/// Ts. Both add that to the delay of a difference, Ts/2.
double slope_filter_time(double samples, double Ts);
/// The samples of a slope as a whole number, from 1 to a million.
int whole_samples(double samples);

}  // namespace tunewright::product
