#include "engine/tuning/rimc/rimc_report.h"

#include "api/contract/reports/reports.h"
#include "api/contract/result/evaluation.h"
#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

const Description<DisturbancePeakCurve>& curve_contract() {
    static const auto description = [] {
        using C = DisturbancePeakCurve;
        Description<C> d(
            "DisturbancePeakCurve",
            "The load response's peak and Ms of this design over its parameter, on the model; scaled, so that "
            "they depend on L/T alone.");
        d.field("lambda_over_tau", &C::lambda_over_tau, abscissa(), "lambda divided by the model's T.")
            .field("DP_over_kp", &C::DP_over_kp, trace(),
                   "Peak of y after a unit load step divided by the model's gain.")
            .field("Ms", &C::Ms, trace(), "Largest |S|.");
        return d;
    }();
    return description;
}

const Description<FullController>& full_controller_contract() {
    static const auto description = [] {
        using F = FullController;
        Description<F> d("FullController",
                         "The controller of Eq. 23, with the model's dead time inside, on the plant as given; the PID "
                         "approximates it.");
        d.field("robustness", &F::robustness, answer(robustness_contract()), "Peaks and margins.")
            .field("load", &F::load, answer(load_contract()), "Figures of the response to the load step.")
            .field("responses", &F::responses, maybe(answer(responses_contract())),
                   "Traces over time; left out with points 0 and for unstable loops.");
        return d;
    }();
    return description;
}

const Description<RimcReport>& rimc_contract() {
    static const auto description = [] {
        using R = RimcReport;
        Description<R> d("Rimc", "Figures of the PID, with its filter, on the model that it was designed for.");
        d.field("lambda", {}, [](const R& report, Writer& out) { out.number(report.controller.lambda); },
                number().schema, "Time constant of the closed loop.", {.unit = "time"})
            .field("Ms", &R::Ms, figure(), "Largest |S|.")
            .field("disturbance_peak", &R::disturbance_peak, figure(),
                   "Largest deviation of y after a unit load step, signed.", {.unit = "y/u"})
            .field("dead_time_error", &R::dead_time_error, figure(),
                   "Error of the model's dead time up to which Eq. 29 of the source holds (the requested one, if any): "
                   "sufficient for stability, not necessary.",
                   {.unit = "time"})
            .field("stability_limit", &R::stability_limit, figure(), "lambda below which the loop is unstable.",
                   {.unit = "time"})
            .field("full_controller", &R::full_controller, or_reason(answer(full_controller_contract())),
                   "For comparison with the PID.")
            .field("disturbance_peak_curve", &R::curve, maybe(answer(curve_contract())), "Only with the option curve.")
            .why_null("Not defined for this design.");
        return d;
    }();
    return description;
}

}  // namespace

ReportContract rimc_report() {
    return report_contract("rimc", rimc_contract(), "For the method rimc: figures of its design on the model.");
}

}  // namespace tunewright::api
