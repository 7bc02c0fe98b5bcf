#include "api/contract/reports/frontier.h"

#include "api/contract/controller.h"
#include "api/contract/method_options.h"
#include "api/contract/plant/typed.h"
#include "api/contract/reports/reports.h"

namespace tunewright::api {
namespace {

const Description<FrontierPoint>& point_contract() {
    static const auto description = [] {
        using P = FrontierPoint;
        Description<P> d("FrontierPoint", "The robust optimum under one limit, and its figures for unit steps.");
        d.field("Ms", &P::Ms, only_answered(number()), "The limit on Ms.")
            .field(
                "controller", {},
                [](const P& point, Writer& out) { controller_contract().write(point.controller, out); },
                one_of(controller_contract()).schema, "The controller.")
            .field("load_IAE", &P::load_IAE, figure(), "IAE of a unit load step.", {.unit = "y time/u"})
            .field("setpoint_IAE", &P::setpoint_IAE, figure(), "IAE of a unit set-point step.", {.unit = "time"})
            .field("overshoot_percent", &P::overshoot_percent, figure(), "Overshoot of the set-point step.",
                   {.unit = "%"})
            .field("Mks", &P::Mks, figure(), "Largest |C S|: the amplification of noise in u.", {.unit = "u/y"})
            .field("TV", &P::TV, figure(), "Total variation of u after a unit set-point step.", {.unit = "u/y"})
            .field(
                "achieved", {},
                [](const P& point, Writer& out) {
                    out.begin_object();
                    out.key("Ms");
                    figure().write(point.achieved_Ms, out);
                    out.key("Mt");
                    figure().write(point.achieved_Mt, out);
                    out.end_object();
                },
                [](SchemaBook&) {
                    const Json figure{{"type", {"number", "null"}}};
                    return Json{{"type", "object"}, {"properties", {{"Ms", figure}, {"Mt", figure}}}};
                },
                "The loop's own peaks, which the limits bound.")
            .why_null("Not finite for this loop.");
        return d;
    }();
    return description;
}

}  // namespace

const Description<Frontier>& frontier_contract() {
    static const auto description = [] {
        Description<Frontier> d("Frontier", "The least load IAE under each limit on Ms.");
        d.field("points", &Frontier::points, list_of(answer(point_contract())),
                "Ascending in Ms; limits that no controller meets are left out.")
            .field("infeasible_below", &Frontier::infeasible_below, nullable_number(),
                   "The lowest feasible limit, if lower ones were requested; otherwise null.")
            .field("compute_ms", &Frontier::compute_ms, only_answered(number()), "Computing time of the curve, ms.");
        return d;
    }();
    return description;
}

const Description<FrontierRequest>& frontier_request_contract() {
    static const auto description = [] {
        using R = FrontierRequest;
        Description<R> d("FrontierRequest", "A plant, and the range of limits for its robust optima.");
        add_labels(d);
        d.field("plant", &R::plant, maybe(plant_model_or_text()), "The plant.", {.required = true});
        for (const OptionDescription& option : frontier_options().descriptions())
            if (option.name != "take")
                d.field(option.name, &R::options, option_codec(option), option.sentence, {.no_default = true});
        d.check([](const Json&, R& request, Reader& reader) { request.subject = subject_of(*request.plant, reader); })
            .example({{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}}},
                      {"Ms", {{"from", 1.1}, {"to", 2.5}, {"points", 30}}}});
        return d;
    }();
    return description;
}

ReportContract frontier_report() {
    return report_contract("frontier", frontier_contract(), "The frontier of robust optima.");
}

}  // namespace tunewright::api
