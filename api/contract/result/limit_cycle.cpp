#include "api/contract/result/limit_cycle.h"

#include "api/describe/codec.h"

namespace tunewright::api {

const Description<UltimatePoint>& ultimate_point_contract() {
    static const auto description = [] {
        Description<UltimatePoint> d("UltimatePoint", "A gain, and the period at which the loop oscillates with it.");
        d.field("Ku", &UltimatePoint::Ku, only_answered(number()), "Ultimate gain.", {.unit = "u/y"})
            .field("Pu", &UltimatePoint::Pu, only_answered(number()), "Period.", {.unit = "time"});
        return d;
    }();
    return description;
}

static const Description<ShiftedPoint>& shifted_point_contract() {
    static const auto description = [] {
        Description<ShiftedPoint> d("ShiftedPoint", "G(sigma + j 2 pi/Pu) = A e^(j phi) (Liu and Gao, Eq. 9).");
        d.field("sigma", &ShiftedPoint::sigma, only_answered(number()), "Shift.", {.unit = "1/time"})
            .field("A", &ShiftedPoint::A, only_answered(number()), "Magnitude.", {.unit = "y/u"})
            .field("phi", &ShiftedPoint::phi, only_answered(number()), "Angle in (-2 pi, 0].", {.unit = "rad"});
        return d;
    }();
    return description;
}

const Description<LimitCycle>& limit_cycle_contract() {
    static const auto description = [] {
        Description<LimitCycle> d("LimitCycle", "The steady oscillation of a relay test.");
        d.field("Pu", &LimitCycle::Pu, only_answered(number()), "Period.", {.unit = "time"})
            .field("Au", &LimitCycle::Au, only_answered(number()), "|G(j 2 pi/Pu)| (Liu and Gao, Eq. 4).",
                   {.unit = "y/u"})
            .field("phi_u", &LimitCycle::phi_u, only_answered(number()), "Its angle, in (-2 pi, 0].", {.unit = "rad"})
            .field("periods", &LimitCycle::periods, only_answered(integer(0, 1 << 30)), "Whole steady periods used.")
            .field("shift", &LimitCycle::shift, maybe(answer(shifted_point_contract())),
                   "The response at the same frequency, shifted into the right half-plane.")
            .field("fit_rms", &LimitCycle::fit_rms, only_answered(maybe(number())),
                   "Root mean square of model minus record over the steady periods (Eq. 15).", {.unit = "y"})
            .field("describing_function", &LimitCycle::describing_function, maybe(answer(ultimate_point_contract())),
                   "Ultimate point by the describing function: an approximation; the model's is better.")
            .field("t_plus", &LimitCycle::t_plus, only_answered(maybe(number())),
                   "How long u stays at its upper level in each period.", {.unit = "time"})
            .field("t_minus", &LimitCycle::t_minus, only_answered(maybe(number())),
                   "How long u stays at its lower level in each period.", {.unit = "time"})
            .field("y_max", &LimitCycle::y_max, only_answered(maybe(number())), "Largest y of the oscillation.",
                   {.unit = "y"})
            .field("y_min", &LimitCycle::y_min, only_answered(maybe(number())), "Smallest y of the oscillation.",
                   {.unit = "y"});
        return d;
    }();
    return description;
}

const Description<FrequencyPoint>& frequency_point_contract() {
    static const auto description = [] {
        Description<FrequencyPoint> d("FrequencyPoint", "A measured value of the plant's frequency response.");
        d.field("omega", &FrequencyPoint::omega, only_answered(number()), "Angular frequency.", {.unit = "rad/time"})
            .field("re", &FrequencyPoint::re, only_answered(number()), "Real part.", {.unit = "y/u"})
            .field("im", &FrequencyPoint::im, only_answered(number()), "Imaginary part.", {.unit = "y/u"})
            .field("std", &FrequencyPoint::std, only_answered(number()), "Standard deviation of each part.",
                   {.unit = "y/u"});
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
