#include "api/contract/range/range_result.h"

#include <limits>

#include "api/contract/result/evaluation.h"

namespace tunewright::api {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // written as null

double known(const std::optional<double>& value) { return value.value_or(kUnknown); }

RangeTraces traces_of(const range::RangeCurve& curve) {
    RangeTraces traces;
    for (const range::PlaceFigures& place : curve.places) {
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
        d.field("Ms", &T::Ms, trace(), "The largest over the place's plants, and over the rows that may be in use.")
            .field("Mt", &T::Mt, trace(), "The same of Mt.")
            .field("relative_IAE", &T::relative_IAE, trace(),
                   "IAE of a load step over that of the place's own optimum under the same limits.")
            .field("Kp", &T::Kp, trace_if_any(), "Of a schedule: the gain in use.", {.unit = "u/y"})
            .field("Ti", &T::Ti, trace_if_any(), "Of a schedule: the integral time in use.", {.unit = "time"})
            .field("Td", &T::Td, trace_if_any(), "Of a schedule: the derivative time in use.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<range::ScheduledRun>& scheduled_run_contract() {
    static const auto description = [] {
        using R = range::ScheduledRun;
        Description<R> d("RangeRun", "The equations with these settings; values are absolute.");
        d.field("y", &R::y, trace(), "The output.", {.unit = "y"})
            .field("u", &R::u, trace(), "The input, limits included.", {.unit = "u"})
            .field("at", &R::at, trace(), "The scheduling variable.")
            .field("Kp", &R::Kp, trace(), "The gain in use.", {.unit = "u/y"})
            .field("IAE", &R::IAE, only_answered(number()), "Of the set point less y.", {.unit = "y time"})
            .field("largest_error", &R::largest_error, only_answered(number()), "Of the set point less y.",
                   {.unit = "y"})
            .field("largest_bump", &R::largest_bump, only_answered(number()), "Of u, where rows switch.", {.unit = "u"})
            .field("switches", &R::switches, only_answered(integer(0, 1 << 30)), "Of rows, with steps.")
            .field("limited", &R::limited, only_answered(boolean()), "The input met a limit.")
            .field("settled", &R::settled, only_answered(boolean()),
                   "At the end y is within 1 % of the passage's size of the set point.")
            .field("ended", &R::ended, unless<std::string>(words(), [](const auto& text) { return text.empty(); }),
                   "Why it ended early.")
            .field("warnings", &R::warnings, list_of(answer(warning_contract())), "Remarks.");
        return d;
    }();
    return description;
}

const Description<range::LinearisingPassage>& linearising_passage_contract() {
    static const auto description = [] {
        using P = range::LinearisingPassage;
        Description<P> d("RangeNonlinearRun",
                         "The equations under the input/output linearising controller that knows their states, made as "
                         "fast as the schedule where that is slowest: (tau s/r + 1)^r of the relative degree r.");
        const auto of_run = [](auto member, const auto& codec) {
            return [member, write = codec.write](const P& p, Writer& out) { write(p.run.*member, out); };
        };
        using R = range::ScheduledRun;
        d.field("y", {}, of_run(&R::y, trace()), trace().schema, "The output.", {.unit = "y"})
            .field("u", {}, of_run(&R::u, trace()), trace().schema, "The input, limits included.", {.unit = "u"})
            .field("tau", {}, [](const P& p, Writer& out) { out.number(p.tau); }, number().schema,
                   "Sum of the loop's time constants.", {.unit = "time"})
            .field("IAE", {}, [](const P& p, Writer& out) { out.number(p.run.IAE); }, number().schema,
                   "Of the set point less y.", {.unit = "y time"})
            .field("limited", {}, of_run(&R::limited, boolean()), boolean().schema, "The input met a limit.")
            .field("settled", {}, of_run(&R::settled, boolean()), boolean().schema,
                   "At the end y is within 1 % of the step of the set point.")
            .field("ended", {}, of_run(&R::ended, words()), words().schema, "Why it ended early.", {},
                   [](const P& p) { return p.run.ended.empty(); });
        return d;
    }();
    return description;
}

/// Times and targets are the same for both of a passage; the longer one has all that there are.
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
    for (const range::PlaceFigures& place : design.schedule_curve.places) {
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
        Description<C> d("RangeCurves", "Arrays over the same places, ascending; null where a figure is not known.");
        d.field("at", &C::at, times_trace(), "The places: evenly over the range, points and rows.")
            .field("K", &C::K, trace(), "Static gain of the nominal plant; of an integrating one the slope.",
                   {.unit = "y/u"})
            .field("T", &C::T, trace(), "Sum of its lags less its leads.", {.unit = "time"})
            .field("L", &C::L, trace(), "Its dead time.", {.unit = "time"})
            .field("u", &C::u, trace_if_any(), "Of equations: the steady input, absolute.", {.unit = "u"})
            .field("y", &C::y, trace_if_any(), "Of equations: the steady output, absolute.", {.unit = "y"})
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
                   "How long it lasts.", {.unit = "time"})
            .field("t", {}, [](const P& p, Writer& out) { times_trace().write(longer(p).t, out); },
                   times_trace().schema, "Times of both runs; one that ended early has fewer.", {.unit = "time"})
            .field(
                "target", {}, [](const P& p, Writer& out) { trace().write(longer(p).target, out); }, trace().schema,
                "The set point of y; along a parameter the parameter.")
            .field("one", &P::one, maybe(answer(scheduled_run_contract())), "With one setting.")
            .field("schedule", &P::schedule, maybe(answer(scheduled_run_contract())), "With the schedule.")
            .field("nonlinear", &P::nonlinear, or_reason(answer(linearising_passage_contract())),
                   "By a nonlinear controller that knows the equations: how well any could pass.")
            .why_null("There is no such controller.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
