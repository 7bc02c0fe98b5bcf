// The series form whose lead is filtered by a given fraction of its own derivative time, as in many blocks:
//   Kc (1 + 1/(ti s)) (1 + td s)/(1 + alpha td s)
// (pid.h's to_series takes the filter's time instead). Back to the ideal form: to_ideal(SeriesPid).
#pragma once

#include <optional>

#include "engine/controller/pid.h"

namespace tunewright::product {

struct RatioSeries {
    double Kc = 0, ti = 0, td = 0;
    /// For complex zeros, which no series form has: the gains of P and D of the nearest series form, as an ideal
    /// controller, relative to the requested ones.
    struct Deviation {
        double min_Ti = 0;  ///< 4 Td/(1 - alpha): the least Ti with real zeros
        double proportional = 1, derivative = 1;
    };
    std::optional<Deviation> deviation = {};
};

/// td = [Ti - sqrt(Ti^2 - 4 Ti Td/(1 - alpha))]/2, ti = Ti - (1 - alpha) td, Kc = Kp ti/Ti: exact, with the
/// derivative's filter Tf = alpha td. 0 <= alpha < 1; Ti may be infinite.
///
/// Below Ti = 4 Td/(1 - alpha) the zeros are complex. Then ti = td = sqrt(Ti Td), Kc = Kp sqrt(Td/Ti), which keeps the
/// integral gain, and for alpha = 0 the derivative gain too; the alternative with the same integral gain, a Td reduced
/// until the zeros are real, would lose derivative action.
RatioSeries ratio_series(double Kp, double Ti, double Td, double alpha);

}  // namespace tunewright::product
