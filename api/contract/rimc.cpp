#include "api/contract/rimc.h"

namespace tunewright::api {
namespace {

const Description<DisturbancePeakCurve>& curve_contract() {
    static const auto description = [] {
        using C = DisturbancePeakCurve;
        Description<C> d(
            "DisturbancePeakCurve",
            "The load response's peak and Ms of this design over its parameter, on the model; scaled, so that "
            "they depend on L/T alone.");
        d.field("lambda_over_tau", &C::lambda_over_tau, trace(), "lambda over the model's T.")
            .field("DP_over_kp", &C::DP_over_kp, trace(), "Peak of y after a unit load step over the model's gain.")
            .field("Ms", &C::Ms, trace(), "Largest |S|.");
        return d;
    }();
    return description;
}

}  // namespace

const Description<RimcEntry>& rimc_contract() {
    static const auto description = [] {
        using R = RimcEntry;
        Description<R> d("Rimc", "Figures of the PID, with its filter, on the model that it was designed for.");
        d.field("lambda", &R::lambda, only_answered(number()), "Time constant of the closed loop.", {.unit = "time"})
            .field("Ms", &R::Ms, figure(), "Largest |S|.")
            .field("disturbance_peak", &R::disturbance_peak, figure(),
                   "Largest deviation of y after a unit load step, signed.", {.unit = "y/u"})
            .field("dead_time_error", &R::dead_time_error, figure(),
                   "Error of the model's dead time up to which Eq. 29 of the source holds (the one asked for, if one "
                   "was): "
                   "sufficient for stability, not necessary.",
                   {.unit = "time"})
            .field("stability_limit", &R::stability_limit, figure(), "lambda below which the loop is unstable.",
                   {.unit = "time"})
            .field("disturbance_peak_curve", &R::disturbance_peak_curve, maybe(answer(curve_contract())),
                   "With the option curve.")
            .why_null(&R::why_null, "Not defined for this design.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
