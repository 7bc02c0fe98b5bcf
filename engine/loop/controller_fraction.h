// The controller as a fraction: the formula with which a loop is evaluated, for one frequency or for two at a time.
// `Number`: std::complex<double> or PairComplex.
#pragma once

#include "engine/controller/pid.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/pair_complex.h"

namespace tunewright {

/// Fraction of the filtered controller, without set-point weights.
template <class Number>
FractionOf<Number> controller_fraction(const ParallelPid& gains, Number s) {
    const double Tf = gains.filter.Tf;
    Number numerator = gains.Kp + gains.Kd * s, denominator = 1;
    switch (gains.filter.type) {
        case FilterType::none: break;
        case FilterType::derivative:
            denominator = 1.0 + Tf * s;
            numerator = gains.Kp * denominator + gains.Kd * s;
            break;
        case FilterType::measurement_first_order: denominator = 1.0 + Tf * s; break;
        case FilterType::measurement_second_order: denominator = 1.0 + product(Tf * s, 1.0 + 0.5 * Tf * s); break;
    }
    if (gains.Ki == 0) return {numerator, denominator};
    const Number integral_path = gains.filter.type == FilterType::derivative ? denominator : Number(1);
    return {product(numerator, s) + gains.Ki * integral_path, product(denominator, s)};
}

}  // namespace tunewright
