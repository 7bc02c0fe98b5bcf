#include "engine/controller/product/series.h"

#include <cmath>

namespace tunewright::product {
namespace {

// Two equal zeros (Ti = 4 Td) may give a small negative value by rounding.
constexpr double kDiscriminantTolerance = 1e-13;

RatioSeries nearest(double Kp, double Ti, double Td, double alpha) {
    RatioSeries series;
    series.ti = series.td = std::sqrt(Ti * Td);
    series.Kc = Kp * std::sqrt(Td / Ti);
    const double left = 1 - alpha;
    series.deviation = {
        .min_Ti = 4 * Td / left, .proportional = series.Kc * (1 + left) / Kp, .derivative = left * left};
    return series;
}

}  // namespace

RatioSeries ratio_series(double Kp, double Ti, double Td, double alpha) {
    // In terms of 1/Ti, so that Ti may be infinite and Td = 0 gives ti = Ti exactly.
    const double left = 1 - alpha;
    double discriminant = 1 - 4 * Td / (left * Ti);
    if (std::abs(discriminant) < kDiscriminantTolerance) discriminant = 0;
    if (discriminant < 0) return nearest(Kp, Ti, Td, alpha);
    const double td = 2 * Td / (left * (1 + std::sqrt(discriminant)));
    const double share = 1 - left * td / Ti;  // ti/Ti
    return {.Kc = Kp * share, .ti = Ti * share, .td = td};
}

}  // namespace tunewright::product
