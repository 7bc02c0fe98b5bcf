#include "api/contract/range/range_result.h"

#include <limits>
#include <utility>

#include "api/contract/controller.h"
#include "api/contract/plant/plant.h"
#include "api/contract/range/range_request.h"
#include "api/contract/result/evaluation.h"
#include "api/contract/result/identified_model.h"
#include "api/contract/result/result.h"

namespace tunewright::api {
namespace {

constexpr const char* kNothingDesigned = "A schedule was given: nothing was designed.";

/// A controller of the ideal form, written like any other.
template <class Owner>
void pid_field(Description<Owner>& d, const char* name, IdealPid Owner::*member, const char* sentence) {
    d.field(
        name, {}, [member](const Owner& owner, Writer& out) { controller_contract().write(owner.*member, out); },
        one_of(controller_contract()).schema, sentence);
}

const Description<range::PointCost>& point_cost_contract() {
    static const auto description = [] {
        using P = range::PointCost;
        Description<P> d("PointCost", "The cost of one setting at a point.");
        d.field("at", &P::at, only_answered(number()), "The point.");
        pid_field(d, "own", &P::own, "The point's own optimum under the same limits.");
        d.field("own_IAE", &P::own_IAE, only_answered(number()), "IAE of a unit load step with it.",
                {.unit = "y time/u"})
            .field("IAE", &P::IAE, figure(), "IAE of a unit load step with the one setting.", {.unit = "y time/u"})
            .field("relative_IAE", &P::relative_IAE, figure(), "IAE divided by own_IAE.")
            .field("Ms", &P::Ms, figure(), "The largest over the plants of the point.")
            .field("Mt", &P::Mt, figure(), "The largest over the plants of the point.")
            .why_null("The loop is not stable here, or does not settle.");
        return d;
    }();
    return description;
}

const Description<range::OneSetting>& one_setting_contract() {
    static const auto description = [] {
        using O = range::OneSetting;
        Description<O> d("OneSetting", "The setting that keeps the limits over the range, and its cost.");
        pid_field(d, "controller", &O::controller, "The controller.");
        d.field("worst_relative_IAE", &O::worst_relative_IAE, only_answered(number()), "The largest at a point.")
            .field("mean_relative_IAE", &O::mean_relative_IAE, only_answered(number()), "The mean over the points.")
            .field("worst_at", &O::worst_at, only_answered(number()), "The point of the largest.")
            .field("points", &O::points, list_of(answer(point_cost_contract())), "Its cost at each point.");
        return d;
    }();
    return description;
}

const Description<ScheduleRow>& schedule_row_contract() {
    static const auto description = [] {
        using R = ScheduleRow;
        Description<R> d("ScheduleRow", "Settings in the ideal form, with a second-order measurement filter.");
        d.field("at", &R::at, only_answered(number()), "Its place.")
            .field("Kp", &R::Kp, only_answered(number()), "Gain.", {.unit = "u/y"})
            .field("Ti", &R::Ti, only_answered(number()), "Integral time.", {.unit = "time"})
            .field("Td", &R::Td, only_answered(number()), "Derivative time.", {.unit = "time"})
            .field("Tf", &R::Tf, only_answered(number()), "Filter time constant; 0: none.", {.unit = "time"})
            .field("b", &R::b, only_answered(number()), "Set-point weight.");
        return d;
    }();
    return description;
}

Json number_or_null(SchemaBook&) { return Json{{"type", {"number", "null"}}}; }

const Description<range::ScheduleDesign>& schedule_contract() {
    static const auto description = [] {
        using S = range::ScheduleDesign;
        Description<S> d("Schedule",
                         "Rows of settings. The controller interpolates between them; below the first and above the "
                         "last row the settings are constant.");
        d.field(
             "interpolation", {},
             [](const S& s, Writer& out) { interpolation_word().write(s.schedule.interpolation, out); },
             interpolation_word().schema, "Interpolation between the rows.")
            .field(
                "hysteresis", {}, [](const S& s, Writer& out) { out.number(s.schedule.hysteresis); }, number().schema,
                "Hysteresis of steps, in the unit of `at`: the controller changes to the next row only half of it "
                "beyond the "
                "border.")
            .field(
                "rows", {},
                [](const S& s, Writer& out) { list_of(answer(schedule_row_contract())).write(s.schedule.rows, out); },
                list_of(answer(schedule_row_contract())).schema, "Ascending in `at`.")
            .field("holds_limits", &S::holds_limits, only_answered(boolean()),
                   "True if the limits hold at every place that was checked.")
            .field("within_allowance", &S::within_allowance, only_answered(boolean()),
                   "True if the IAE is within the allowance of each place's own optimum everywhere.")
            .field(
                "worst_relative_IAE", {}, [](const S& s, Writer& out) { out.number(s.worst_relative_IAE); },
                number_or_null, "The largest value found; null if a loop is not stable.")
            .field(
                "longest_sample_time", {},
                [](const S& s, Writer& out) {
                    s.longest_sample_time ? out.number(*s.longest_sample_time) : out.null();
                },
                number_or_null,
                "The longest sample time of a program with backward rules that keeps Ms within 5 % of the continuous "
                "loop's at the range's points and at the rows; null: none was found.",
                {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<range::WorstPoint>& worst_point_contract() {
    static const auto description = [] {
        using W = range::WorstPoint;
        using enum range::Quantity;
        Description<W> d("WorstPlace",
                         "The place where a quantity is largest over the range, recomputed independently.");
        d.field("quantity", &W::quantity,
                only_answered(
                    choice<range::Quantity>({{"Ms", Ms}, {"Mt", Mt}, {"relative_IAE", range::Quantity::relative_IAE}})),
                "The quantity.")
            .field("at", &W::at, only_answered(number()), "The place.")
            .field("value", &W::value, figure(), "There.")
            .field("limit", &W::limit, only_answered(number()),
                   "Limit of Ms or Mt; for the relative IAE 1 plus the allowance.")
            .why_null("The loop is not stable there, or does not settle.");
        return d;
    }();
    return description;
}

const Description<RangeWorst>& worst_contract() {
    static const auto description = [] {
        const auto places = unless<std::vector<range::WorstPoint>>(list_of(answer(worst_point_contract())),
                                                                   [](const auto& list) { return list.empty(); });
        Description<RangeWorst> d("RangeWorst", "The worst places of each.");
        d.field("one", &RangeWorst::one, places, "With one setting.")
            .field("schedule", &RangeWorst::schedule, places, "With the schedule.");
        return d;
    }();
    return description;
}

const Description<RangePointPlant>& range_plant_contract() {
    static const auto description = [] {
        using P = RangePointPlant;
        Description<P> d("RangePoint", "The plant at a point, and its source.");
        d.field("at", &P::at, only_answered(number()), "The point.")
            .field("plant", &P::plant, only_answered(one_of(plant_contract())),
                   "As given, identified from the record, or the equations' linearisation.")
            .field("model", &P::model, maybe(answer(model_contract())), "The model of a record.")
            .field("u", &P::u, only_answered(maybe(number())), "For equations: the steady input, absolute.",
                   {.unit = "u"})
            .field("y", &P::y, only_answered(maybe(number())), "For equations: the steady output, absolute.",
                   {.unit = "y"});
        return d;
    }();
    return description;
}

Json scheduling_schema(SchemaBook&) {
    const Json number{{"type", "number"}}, text{{"type", "string"}};
    return {{"type", "object"},
            {"properties", {{"name", text}, {"unit", text}, {"from", number}, {"to", number}}},
            {"required", {"name", "from", "to"}}};
}

void write_scheduling(const RangeContent& content, Writer& out) {
    out.begin_object();
    out.key("name").text(content.result.scheduling.name);
    if (!content.result.scheduling.unit.empty()) out.key("unit").text(content.result.scheduling.unit);
    out.key("from").number(content.result.low);
    out.key("to").number(content.result.high);
    out.end_object();
}

template <class T>
OrReason<T> with_reason(std::optional<T> value, std::string why) {
    return {std::move(value), std::move(why)};
}

}  // namespace

RangeContent::RangeContent(RangeResult of) : result(std::move(of)) {
    curves = curves_of(result);
    range::RangeDesign& design = result.design;
    worst = {design.one_curve.worst, design.schedule_curve.worst};
    one = with_reason(std::move(design.one), result.given ? kNothingDesigned : design.why_no_one);
    schedule = with_reason(std::move(design.schedule), design.why_no_schedule);
}

const Description<RangeContent>& range_content_contract() {
    static const auto description = [] {
        using C = RangeContent;
        Description<C> d("Range", "One setting and a schedule for an operating range, with their costs.");
        d.field("scheduling", {}, write_scheduling, scheduling_schema, "The scheduling variable and its range.")
            .field(
                "stated", {}, [](const C& c, Writer& out) { out.text(c.result.design.stated); }, words().schema,
                "Source of the plants between the points.")
            .field(
                "points", {},
                [](const C& c, Writer& out) { list_of(answer(range_plant_contract())).write(c.result.points, out); },
                list_of(answer(range_plant_contract())).schema, "The plants at the points.")
            .field("one", &C::one, or_reason(answer(one_setting_contract())), "One setting for the range.")
            .field("schedule", &C::schedule, or_reason(answer(schedule_contract())), "The schedule.")
            .field("curves", &C::curves, answer(range_curves_contract()), "Figures over the range.")
            .field("worst", &C::worst, answer(worst_contract()), "The worst places of each.")
            .field(
                "verdict", {}, [](const C& c, Writer& out) { finding_contract().write(*c.result.verdict, out); },
                [](SchemaBook& book) { return finding_contract().schema(book); },
                "Whether a schedule is worthwhile; for a given schedule, whether it holds the limits and what it "
                "costs.",
                {}, [](const C& c) { return !c.result.verdict; })
            .field(
                "runs", {},
                [](const C& c, Writer& out) { list_of(answer(range_passage_contract())).write(c.result.runs, out); },
                list_of(answer(range_passage_contract())).schema, "For equations: passages across the range.", {},
                [](const C& c) { return c.result.runs.empty(); })
            .field(
                "warnings", {},
                [](const C& c, Writer& out) {
                    list_of(answer(warning_contract())).write(c.result.design.warnings, out);
                },
                list_of(answer(warning_contract())).schema, "Remarks.")
            .why_null("None was found.");
        return d;
    }();
    return description;
}

namespace {

Description<RangeAnswer>& add_range(Description<RangeAnswer>& d) {
    d.field(
         "range", {}, [](const RangeAnswer& a, Writer& out) { range_content_contract().write(a.range, out); },
         [](SchemaBook& book) { return range_content_contract().schema(book); }, "The answer.")
        .field(
            "compute_ms", {}, [](const RangeAnswer& a, Writer& out) { out.number(a.range.result.compute_ms); },
            number().schema, "Computing time, ms.");
    return d;
}

}  // namespace

const Description<RangeAnswer>& range_result_contract() {
    static const auto description = [] {
        using A = RangeAnswer;
        Description<A> d("RangeResult", "The result of a job about an operating range.");
        d.field("units", &A::units, only_answered(maybe(object(units_contract()))), "As sent.");
        add_range(d)
            .field(
                "partial", {}, [](const A& a, Writer& out) { out.boolean(a.range.result.design.partial); },
                boolean().schema, "True: cancelled after a setting was found; this is the best so far.")
            .field(
                "version", {}, [](const A&, Writer& out) { out.text(TUNEWRIGHT_VERSION); }, words().schema,
                "Version of the service.")
            .field("request_hash", &A::request_hash, words(), "SHA-256 of the request in its canonical form.");
        return d;
    }();
    return description;
}

const Description<RangeAnswer>& range_answer_contract() {
    static const auto description = [] {
        Description<RangeAnswer> d("RangeCallAnswer", "An operating range, answered while the client waits.");
        add_range(d);
        return d;
    }();
    return description;
}

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // written as null

double known(const std::optional<double>& value) { return value.value_or(kUnknown); }

RangeTraces traces_of(const range::RangeCurve& curve) {
    RangeTraces traces;
    for (const range::PointFigures& place : curve.places) {
        traces.Ms.push_back(known(place.Ms));
        traces.Mt.push_back(known(place.Mt));
        traces.relative_IAE.push_back(known(place.relative_IAE));
    }
    return traces;
}

Codec<std::vector<double>> trace_if_any() {
    return unless<std::vector<double>>(trace(), [](const auto& values) { return values.empty(); });
}

const Description<RangeTraces>& range_traces_contract() {
    static const auto description = [] {
        using T = RangeTraces;
        Description<T> d("RangeTraces", "Figures at each place of the curves; null where the loop is not stable.");
        d.field("Ms", &T::Ms, trace(), "The largest Ms over the place's plants, and over the rows that may be in use.")
            .field("Mt", &T::Mt, trace(),
                   "The largest Mt over the place's plants, and over the rows that may be in use.")
            .field("relative_IAE", &T::relative_IAE, trace(),
                   "IAE of a load step divided by that of the place's own optimum under the same limits.")
            .field("Kp", &T::Kp, trace_if_any(), "For a schedule: the gain in use.", {.unit = "u/y"})
            .field("Ti", &T::Ti, trace_if_any(), "For a schedule: the integral time in use.", {.unit = "time"})
            .field("Td", &T::Td, trace_if_any(), "For a schedule: the derivative time in use.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<range::ScheduledRun>& scheduled_run_contract() {
    static const auto description = [] {
        using R = range::ScheduledRun;
        Description<R> d("RangeRun", "The equations with these settings; values are absolute.");
        d.field("y", &R::y, trace(), "The output.", {.unit = "y"})
            .field("u", &R::u, trace(), "The input, after its limits.", {.unit = "u"})
            .field("at", &R::at, trace(), "The scheduling variable.")
            .field("Kp", &R::Kp, trace(), "The gain in use.", {.unit = "u/y"})
            .field("IAE", &R::IAE, only_answered(number()), "IAE of the set point minus y.", {.unit = "y time"})
            .field("largest_error", &R::largest_error, only_answered(number()),
                   "Largest absolute value of the set point minus y.", {.unit = "y"})
            .field("largest_bump", &R::largest_bump, only_answered(number()), "Largest jump of u when rows switch.",
                   {.unit = "u"})
            .field("switches", &R::switches, only_answered(integer(0, 1 << 30)),
                   "Number of changes of row, with steps.")
            .field("limited", &R::limited, only_answered(boolean()), "True if the input reached a limit.")
            .field("settled", &R::settled, only_answered(boolean()),
                   "At the end y is within 1 % of the passage's size of the set point.")
            .field("ended", &R::ended, unless<std::string>(words(), [](const auto& text) { return text.empty(); }),
                   "Reason why it ended early.")
            .field("warnings", &R::warnings, list_of(answer(warning_contract())), "Remarks.");
        return d;
    }();
    return description;
}

const Description<range::LinearisingPassage>& linearising_passage_contract() {
    static const auto description = [] {
        using P = range::LinearisingPassage;
        Description<P> d("RangeNonlinearRun",
                         "The equations with the input/output linearising controller that knows their states, as fast "
                         "as the schedule at its slowest place: (tau s/r + 1)^r of the relative degree r.");
        const auto of_run = [](auto member, const auto& codec) {
            return [member, write = codec.write](const P& p, Writer& out) { write(p.run.*member, out); };
        };
        using R = range::ScheduledRun;
        d.field("y", {}, of_run(&R::y, trace()), trace().schema, "The output.", {.unit = "y"})
            .field("u", {}, of_run(&R::u, trace()), trace().schema, "The input, after its limits.", {.unit = "u"})
            .field("tau", {}, [](const P& p, Writer& out) { out.number(p.tau); }, number().schema,
                   "Sum of the loop's time constants.", {.unit = "time"})
            .field("IAE", {}, [](const P& p, Writer& out) { out.number(p.run.IAE); }, number().schema,
                   "IAE of the set point minus y.", {.unit = "y time"})
            .field("limited", {}, of_run(&R::limited, boolean()), boolean().schema,
                   "True if the input reached a limit.")
            .field("settled", {}, of_run(&R::settled, boolean()), boolean().schema,
                   "At the end y is within 1 % of the step of the set point.")
            .field("ended", {}, of_run(&R::ended, words()), words().schema, "Reason why it ended early.", {},
                   [](const P& p) { return p.run.ended.empty(); });
        return d;
    }();
    return description;
}

/// Times and targets are the same for both runs of a passage; the longer run has all of them.
const range::ScheduledRun& longer(const RangePassage& passage) {
    if (!passage.schedule) return *passage.one;
    if (!passage.one) return *passage.schedule;
    return passage.one->t.size() > passage.schedule->t.size() ? *passage.one : *passage.schedule;
}

}  // namespace

RangeCurves curves_of(const RangeResult& result) {
    RangeCurves curves;
    for (const RangePlace& place : result.places) {
        curves.at.push_back(place.at);
        curves.K.push_back(known(place.K));
        curves.T.push_back(known(place.T));
        curves.L.push_back(known(place.L));
        if (!place.y) continue;
        curves.u.push_back(known(place.u));
        curves.y.push_back(known(place.y));
    }
    const range::RangeDesign& design = result.design;
    if (!design.one_curve.places.empty()) curves.one = traces_of(design.one_curve);
    if (design.schedule_curve.places.empty() || !design.schedule) return curves;
    RangeTraces& schedule = curves.schedule.emplace(traces_of(design.schedule_curve));
    for (const range::PointFigures& place : design.schedule_curve.places) {
        const IdealPid pid = settings_at(design.schedule->schedule, place.at);
        schedule.Kp.push_back(pid.Kp);
        schedule.Ti.push_back(pid.Ti);
        schedule.Td.push_back(pid.Td);
    }
    return curves;
}

const Description<RangeCurves>& range_curves_contract() {
    static const auto description = [] {
        using C = RangeCurves;
        Description<C> d("RangeCurves", "Arrays over the same places, ascending; null for an unknown figure.");
        d.field("at", &C::at, times_trace(), "The places: evenly spaced over the range, and at points and rows.")
            .field("K", &C::K, trace(), "Static gain of the nominal plant; for an integrating one the slope.",
                   {.unit = "y/u"})
            .field("T", &C::T, trace(), "Sum of its lags minus sum of its leads.", {.unit = "time"})
            .field("L", &C::L, trace(), "Its dead time.", {.unit = "time"})
            .field("u", &C::u, trace_if_any(), "For equations: the steady input, absolute.", {.unit = "u"})
            .field("y", &C::y, trace_if_any(), "For equations: the steady output, absolute.", {.unit = "y"})
            .field("one", &C::one, maybe(answer(range_traces_contract())), "With one setting.")
            .field("schedule", &C::schedule, maybe(answer(range_traces_contract())), "With the schedule.");
        return d;
    }();
    return description;
}

const Description<RangePassage>& range_passage_contract() {
    static const auto description = [] {
        using P = RangePassage;
        Description<P> d("RangePassage", "A passage across the range, on the equations.");
        d.field(
             "name", {}, [](const P& p, Writer& out) { out.text(p.passage.name); }, words().schema,
             "step up, step down, stairs or ramp.")
            .field("horizon", {}, [](const P& p, Writer& out) { out.number(p.passage.horizon); }, number().schema,
                   "Duration.", {.unit = "time"})
            .field("t", {}, [](const P& p, Writer& out) { times_trace().write(longer(p).t, out); },
                   times_trace().schema, "Times of both runs; one that ended early has fewer.", {.unit = "time"})
            .field(
                "target", {}, [](const P& p, Writer& out) { trace().write(longer(p).target, out); }, trace().schema,
                "The set point of y; along a parameter the parameter.")
            .field("one", &P::one, maybe(answer(scheduled_run_contract())), "With one setting.")
            .field("schedule", &P::schedule, maybe(answer(scheduled_run_contract())), "With the schedule.")
            .field("nonlinear", &P::nonlinear, or_reason(answer(linearising_passage_contract())),
                   "With a nonlinear controller that knows the equations: the best possible passage.")
            .why_null("There is no such controller.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
