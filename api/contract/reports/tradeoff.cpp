#include "api/contract/plant/plant.h"
#include "api/contract/reports/reports.h"
#include "engine/tuning/arrieta/tradeoff_report.h"

namespace tunewright::api {
namespace {

constexpr const char* kNone = "Not defined for this controller.";

const Description<TradeoffFigures>& figures_contract() {
    static const auto description = [] {
        using F = TradeoffFigures;
        Description<F> d("TradeoffFigures",
                         "Distance of the controller from the optima for set points and for loads. Both indices are "
                         "for unit steps on the plant scaled to static gain 1.");
        d.field("J_r", &F::J_r, figure(), "IAE of the set-point step.", {.unit = "time"})
            .field("J_d", &F::J_d, figure(), "IAE of the load step divided by |K|.", {.unit = "time"})
            .field("J_rd", &F::J_rd, figure(), "Distance of (J_r, J_d) from (J_r_opt, J_d_opt).", {.unit = "time"})
            .field("J_r_opt", &F::J_r_opt, figure(), "J_r of the best PID for set points on the model.",
                   {.unit = "time"})
            .field("J_d_opt", &F::J_d_opt, figure(), "J_d of the best PID for loads on the model.", {.unit = "time"})
            .field("I_perf", &F::I_perf, figure(),
                   "J_rd of the servo/regulation rule without a limit on Ms divided by this J_rd; 1 is equally good.")
            .field("Deg", &F::Deg, figure(), "1 - I_perf: the cost of robustness. Negative: better than that rule.")
            .field("Ms", &F::Ms, figure(), "Largest |S|.")
            .why_null(kNone);
        return d;
    }();
    return description;
}

void add_curve_fields(Description<ProfilePoint>& d) {
    using P = ProfilePoint;
    const auto figure = only_answered(number());
    d.field("Ms", &P::Ms, figure, "Largest |S| on the model.")
        .field("J_r", &P::J_r, figure, "IAE of the set-point step.", {.unit = "time"})
        .field("J_d", &P::J_d, figure, "IAE of the load step divided by |K|.", {.unit = "time"})
        .field("J_rd", &P::J_rd, figure, "Distance from the corner of both optima.", {.unit = "time"})
        .field("I_perf", &P::I_perf, figure, "J_rd of the rule without a limit on Ms divided by this J_rd.")
        .field("Deg", &P::Deg, figure, "1 - I_perf.");
}

const Description<ProfilePoint>& Ms_point_contract() {
    static const auto description = [] {
        Description<ProfilePoint> d("TradeoffAtMs", "The rule designed for one Ms (Eq. 9), on the model.");
        d.field("Ms_design", &ProfilePoint::level, only_answered(number()), "The requested Ms.");
        add_curve_fields(d);
        return d;
    }();
    return description;
}

const Description<ProfilePoint>& level_contract() {
    static const auto description = [] {
        Description<ProfilePoint> d("TradeoffAtLevel", "The rule at one level of Table 2, on the model.");
        d.field("degradation", &ProfilePoint::level, only_answered(number()), "The degradation allowed.");
        add_curve_fields(d);
        return d;
    }();
    return description;
}

const Description<TradeoffProfile>& profile_contract() {
    static const auto description = [] {
        Description<TradeoffProfile> d("TradeoffProfile", "The results of the servo/regulation rule on the model.");
        d.field("by_Ms", &TradeoffProfile::by_Ms, list_of(answer(Ms_point_contract())),
                "Ms from 1.4 to 2; those without a stable loop are left out.")
            .field("by_degradation", &TradeoffProfile::by_degradation, list_of(answer(level_contract())),
                   "The levels of Table 2.");
        return d;
    }();
    return description;
}

const Description<TradeoffReport>& tradeoff_contract() {
    static const auto description = [] {
        using T = TradeoffReport;
        Description<T> d(
            "Tradeoff",
            "Servo against regulation (Arrieta, Vilanova and Alfaro 2012), on the first-order model and on "
            "the plant.");
        d.field("fopdt", &T::fopdt, maybe(only_answered(one_of(plant_contract()))),
                "The first-order model of the optima.")
            .field("constants", &T::constants, maybe(only_answered(text(1000))),
                   "For the methods arrieta_*: the table and column, or the equation, of the settings.")
            .field("Ms_design", &T::Ms_design, maybe(only_answered(number())),
                   "For the methods arrieta_*: the Ms of Table 1's column or of Eq. 9, if any.")
            .field("model", &T::model, answer(figures_contract()), "Figures on the first-order model.")
            .field("plant", &T::plant, answer(figures_contract()),
                   "Figures on the plant, including those of the model's optima.")
            .field("profile", &T::profile, maybe(answer(profile_contract())), "Only with the option profile.");
        return d;
    }();
    return description;
}

}  // namespace

ReportContract tradeoff_report() {
    return report_contract(
        "tradeoff", tradeoff_contract(),
        "Servo against regulation: for the methods arrieta_*, and for any controller with evaluate.tradeoff.", true);
}

}  // namespace tunewright::api
