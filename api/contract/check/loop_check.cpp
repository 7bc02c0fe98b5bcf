#include "api/contract/check/loop_check.h"

#include <cmath>

#include "api/contract/controller.h"
#include "api/contract/plant/plant.h"
#include "api/contract/record.h"
#include "api/contract/result/evaluation.h"

namespace tunewright::api {
namespace {

using namespace check;

constexpr const char* kNotKnown = "The record does not tell.";

Codec<double> answered() { return only_answered(number()); }

template <class T>
Codec<std::vector<T>> answered_list(const Description<T>& description) {
    return list_of(answer(description));
}

const Description<RecordQuality>& quality_contract() {
    static const auto description = [] {
        using Q = RecordQuality;
        Description<Q> d("CheckedRecord", "How good the record is. Shares are from 0 to 1.");
        d.field("rows", &Q::rows, only_answered(integer(0, 1 << 30)), "Its rows.")
            .field("sample_time", &Q::sample_time, answered(), "Median time from row to row.", {.unit = "time"})
            .field("duration", &Q::duration, answered(), "From the first row to the last.", {.unit = "time"})
            .field("missing", &Q::missing, answered(), "Share of rows without a usable measurement.")
            .field("held", &Q::held, answered(), "Share of rows that repeat the measurement of the row before.")
            .field("longest_gap", &Q::longest_gap, answered(), "Longest time without a measurement.", {.unit = "time"})
            .field("noise", &Q::noise, answered(), "Standard deviation of the measurement from row to row.",
                   {.unit = "y"})
            .field("y_step", &Q::y_step, answered(), "Grid of the measurement; 0: none found.", {.unit = "y"})
            .field("u_step", &Q::u_step, answered(), "Grid of the output; 0: none found.", {.unit = "u"})
            .field("at_limit", &Q::at_limit, figure(),
                   "Share of rows with a measurement at an end of range.pv; from 0.05 on no cause is concluded.")
            .field("compressed", &Q::compressed, only_answered(boolean()),
                   "True if the historian stored only some of the values.")
            .field("enough", &Q::enough, only_answered(boolean()), "False: no diagnosis is possible.")
            .field("remarks", &Q::remarks, list_of(answer(warning_contract())), "What is wrong with the record.")
            .field("readings", &Q::readings, list_of(words()),
                   "How the file was read, such as which column is the measurement.")
            .why_null("The range of the measurement is not given.");
        return d;
    }();
    return description;
}

const Description<ServiceShares>& service_contract() {
    static const auto description = [] {
        using S = ServiceShares;
        Description<S> d("LoopService", "Shares of the time, 0 to 1.");
        d.field("automatic", &S::automatic, figure(), "In automatic or cascade.")
            .field("manual", &S::manual, figure(), "In manual.")
            .field("saturated_low", &S::saturated_low, answered(), "Output at its lower limit.")
            .field("saturated_high", &S::saturated_high, answered(), "Output at its upper limit.")
            .field("output_still", &S::output_still, answered(), "Output at rest, away from its limits.")
            .field(
                "longest_still", &S::longest_still, answered(),
                "Share in one piece with a measurement that stands still while the output moves, if it is far longer "
                "than the other pieces; else 0.")
            .field("measurement_still", &S::measurement_still, answered(),
                   "Measurement at rest while the output moves.")
            .why_null(kNotKnown);
        return d;
    }();
    return description;
}

const Description<Period>& period_contract() {
    static const auto description = [] {
        Description<Period> d("LoopPeriod", "An oscillation of the error.");
        d.field("period", &Period::period, answered(), "Its period.", {.unit = "time"})
            .field("period_error", &Period::period_error, answered(), "Standard error of the period.", {.unit = "time"})
            .field("regularity", &Period::regularity, answered(),
                   "Above 1 it is regular (Thornhill, Huang and Zhang 2003).")
            .field("share", &Period::share, answered(), "Share of the error's variance, 0 to 1.")
            .field("amplitude", &Period::amplitude, answered(), "Half of peak to peak.", {.unit = "y"});
        return d;
    }();
    return description;
}

/// The members of the answer, `period` and `regularity`, are those of the strongest.
const Description<Oscillation>& oscillation_contract() {
    static const auto description = [] {
        using O = Oscillation;
        Description<O> d("LoopOscillation", "Regular oscillations of the error, the strongest first.");
        const auto of_first = [](double Period::*member) {
            return [member](const O& found, Writer& out) {
                found.periods.empty() ? out.null() : out.number(found.periods.front().*member);
            };
        };
        const auto nullable = [](SchemaBook&) { return Json{{"type", {"number", "null"}}}; };
        d.field("found", &O::found, only_answered(boolean()), "True if there is one.")
            .field("period", {}, of_first(&Period::period), nullable, "Period of the strongest; null: none.",
                   {.unit = "time"})
            .field("regularity", {}, of_first(&Period::regularity), nullable, "Its regularity; null: none.")
            .field("periods", &O::periods, answered_list(period_contract()), "All of them.");
        return d;
    }();
    return description;
}

const Description<Evidence>& evidence_contract() {
    static const auto description = [] {
        using E = Evidence;
        Description<E> d("CheckEvidence", "A figure that speaks for or against a cause.");
        d.field("code", &E::code, words(), "For programs.")
            .field("value", &E::value, answered(), "The figure.")
            .field("limit", &E::limit, only_answered(maybe(number())), "The value at which it would turn.")
            .field("detail", &E::detail, words(), "A sentence with the figure.");
        return d;
    }();
    return description;
}

Codec<Confidence> confidence() {
    using enum Confidence;
    return choice<Confidence>({{"sure", sure}, {"likely", likely}, {"open", open}});
}

const Description<Cause>& cause_contract() {
    static const auto description = [] {
        Description<Cause> d("LoopCause", "Why the loop is as it is.");
        d.field("verdict", &Cause::verdict, only_answered(check_verdict()), "The cause.")
            .field("confidence", &Cause::confidence, only_answered(confidence()),
                   "open: the verdict is undetermined or insufficient-data.")
            .field("evidence", &Cause::evidence, answered_list(evidence_contract()), "The strongest first.")
            .field("alternatives", &Cause::alternatives, only_answered(list_of(check_verdict())),
                   "Other causes that the record does not exclude, the likeliest first.")
            .field("size", &Cause::size, figure(),
                   "Of a sticking valve its dead band and stick, of a backlash its width.", {.unit = "u"})
            .field("jump", &Cause::jump, figure(), "By which a sticking valve jumps when it breaks loose.",
                   {.unit = "u"})
            .field("period", &Cause::period, figure(), "Of the cycle that this cause makes.", {.unit = "time"})
            .field("why_open", &Cause::why_open,
                   unless<std::string>(words(), [](const std::string& why) { return why.empty(); }),
                   "Why the record does not tell the cause.")
            .why_null("Only a sticking valve or a backlash has one.");
        return d;
    }();
    return description;
}

const Description<HarrisRange>& harris_contract() {
    static const auto description = [] {
        using H = HarrisRange;
        Description<H> d("HarrisRange",
                         "The variance that no controller can avoid over the variance of the error, for all dead times "
                         "between the two delays; 1 is best. It is a range, not a grade.");
        d.field("low", &H::low, answered(), "Its lower end.")
            .field("high", &H::high, answered(), "Its upper end.")
            .field("delays", {},
                   [](const H& range, Writer& out) {
                       out.begin_array();
                       for (const double delay : range.delays) out.number(delay);
                       out.end_array();
                   },
                   numbers(2, 2).schema, "Shortest and longest delay.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<PerformanceFigures>& loop_performance_contract() {
    static const auto description = [] {
        using P = PerformanceFigures;
        Description<P> d("LoopPerformance", "How much error and output move.");
        d.field("harris", &P::harris, or_reason(answer(harris_contract())), "Against what a controller could do.")
            .field("idle_index", &P::idle_index, figure(),
                   "-1 to 1: above 0.4 sluggish, below -0.4 quick (Hägglund 1999).")
            .field("variability", &P::variability, answered(), "Standard deviation of the error.", {.unit = "y"})
            .field("variability_share", &P::variability_share, figure(),
                   "Standard deviation of the error over the range of the measurement.")
            .field("mean_error", &P::mean_error, answered(), "Mean magnitude of the error.", {.unit = "y"})
            .field("independent", &P::independent, answered(), "Values of the error that count as independent.")
            .field("following", &P::following, figure(),
                   "Variance of the error over that of the set point, where the set point moves.")
            .field("offset", &P::offset, answered(), "Mean of the error.", {.unit = "y"})
            .field("travel", &P::travel, figure(), "Of the output, ranges an hour.")
            .field("reversals", &P::reversals, figure(), "Of the output, an hour.")
            .why_null(kNotKnown);
        return d;
    }();
    return description;
}

Codec<Owner> action_owner() {
    using enum Owner;
    return choice<Owner>({{"nobody", nobody},
                          {"control", control},
                          {"instruments", instruments},
                          {"process", process},
                          {"operations", operations}});
}

const Description<Action>& action_contract() {
    static const auto description = [] {
        Description<Action> d("CheckAction", "What to do first.");
        d.field("code", &Action::code, only_answered(check_action()), "For programs.")
            .field("owner", &Action::owner, only_answered(action_owner()), "Whose work it is.")
            .field("detail", &Action::detail, words(), "A sentence.");
        return d;
    }();
    return description;
}

const Description<TestPlan>& test_plan_contract() {
    static const auto description = [] {
        using P = TestPlan;
        using enum P::Kind;
        Description<P> d("CheckTest", "The test that shows the plant: steps up and down.");
        d.field("kind", &P::kind,
                only_answered(choice<P::Kind>({{"set-point-steps", set_point_steps}, {"output-steps", output_steps}})),
                "In automatic, or in manual.")
            .field("size", &P::size, answered(), "Of each step, in the unit of y or u.")
            .field("steps", &P::steps, only_answered(integer(1, 100)), "How many.")
            .field("hold", &P::hold, answered(), "How long each is held.", {.unit = "time"})
            .field("duration", &P::duration, answered(), "Of the whole test.", {.unit = "time"})
            .field("beyond_seen", &P::beyond_seen, only_answered(boolean()),
                   "True: the size is more than the record's own range.")
            .field("detail", &P::detail, words(), "A sentence.");
        return d;
    }();
    return description;
}

const Description<CycleStop>& cycle_stop_contract() {
    static const auto description = [] {
        using S = CycleStop;
        using enum StopMeans;
        Description<S> d("CycleStop", "PI settings with which the cycle of a sticking valve ends.");
        d.field("means", &S::means,
                only_answered(
                    choice<StopMeans>({{"integral-time", integral_time}, {"gap", gap}, {"no-integral", no_integral}})),
                "A longer integral time; a gap on the error; no integral action. Each may need a lower gain too.")
            .field("Kp", &S::Kp, answered(), "Gain.", {.unit = "u/y"})
            .field("Ti", &S::Ti, only_answered(maybe(number())), "Integral time; left out without integral action.",
                   {.unit = "time"})
            .field("gap", &S::gap, answered(), "The integral rests while the magnitude of the error is at most this.",
                   {.unit = "y"})
            .field(
                "error_ratio", {},
                [](const S& stop, Writer& out) {
                    out.begin_array();
                    for (const double end : stop.error_ratio) out.number(end);
                    out.end_array();
                },
                numbers(2, 2).schema,
                "Mean magnitude of the error over five periods of the cycle after a step of the load as large as the "
                "valve's band, over that of today's settings, both with a good valve: lowest and highest over the "
                "plants that make the recorded cycle.")
            .field("standing_error", &S::standing_error, answered(),
                   "Largest error that remains with the sticking valve after loads up to its band.", {.unit = "y"})
            .field("detail", &S::detail, words(), "A sentence.");
        return d;
    }();
    return description;
}

const Description<CycleStops>& cycle_stops_contract() {
    static const auto description = [] {
        using S = CycleStops;
        using enum S::Outcome;
        Description<S> d("CycleStops",
                         "Settings that stop the cycle of a sticking valve until it is repaired, by simulation.");
        d.field(
             "outcome", &S::outcome,
             only_answered(choice<S::Outcome>({{"found", found}, {"none", none}, {"not-told", not_told}})),
             "found; none of the search stops the cycle surely; or it cannot be told, because the simulated loop does "
             "not make the recorded cycle or something is not known (detail).")
            .field("stops", &S::stops, answered_list(cycle_stop_contract()), "At most one for each means.")
            .field(
                "plant", {}, [](const S& stops, Writer& out) { plant_contract().write(Plant(*stops.plant), out); },
                one_of(plant_contract()).schema, "The plant behind the valve.", {},
                [](const S& stops) { return !stops.plant; })
            .field("period", &S::period, figure(), "Period of the simulated cycle.", {.unit = "time"})
            .field("amplitude", &S::amplitude, figure(),
                   "Of the measurement in the simulated cycle: sqrt 2 times its standard deviation.", {.unit = "y"})
            .field("recorded_amplitude", &S::recorded_amplitude, answered(), "The same of the record; 0: not told.",
                   {.unit = "y"})
            .field("detail", &S::detail, words(), "A sentence.")
            .why_null("It cannot be told.");
        return d;
    }();
    return description;
}

const Description<LoopCure>& cure_contract() {
    static const auto description = [] {
        using C = LoopCure;
        Description<C> d("LoopCure", "From the cause to the settings.");
        const auto pid = [&](const char* name, std::optional<IdealPid> C::*member, const char* sentence) {
            d.field(
                name, {},
                [member](const C& cure, Writer& out) { controller_contract().write(Controller(*(cure.*member)), out); },
                one_of(controller_contract()).schema, sentence, {},
                [member](const C& cure) { return !(cure.*member); });
        };
        pid("settings", &C::settings, "The new settings; left out if the record does not suffice for them.");
        pid("today", &C::today, "Today's settings, as given or as the record shows them.");
        d.field("plant", &C::plant, only_answered(maybe(one_of(plant_contract()))), "The identified plant.")
            .field("worst_Ms", &C::worst_Ms, figure(), "The largest Ms on the plants that fit the record.")
            .field("error_ratio", &C::error_ratio, figure(),
                   "Mean magnitude of the error in the recorded time, with the new settings over that of the record.")
            .field("test", &C::test, only_answered(maybe(answer(test_plan_contract()))),
                   "The test to make; without settings.")
            .field("valve", &C::valve, only_answered(maybe(answer(cycle_stops_contract()))),
                   "With a sticking valve: settings until it is repaired.")
            .field("detail", &C::detail, words(), "A sentence.")
            .why_null("There are no settings.");
        return d;
    }();
    return description;
}

Codec<std::vector<float>> short_numbers() {
    Codec<std::vector<float>> codec;
    codec.read = [](const Json& value, std::vector<float>& target, Reader& reader) {
        std::vector<double> read;
        numbers(0, kShapePoints).read(value, read, reader);
        target.assign(read.begin(), read.end());
    };
    codec.write = [](const std::vector<float>& values, Writer& out) {
        out.begin_array();
        for (const float value : values) out.number(std::round(1e3 * double(value)) / 1e3);
        out.end_array();
    };
    codec.schema = numbers(0, kShapePoints).schema;
    return codec;
}

const Description<Shape>& shape_contract() {
    static const auto description = [] {
        Description<Shape> d("LoopShape", "What the judgement of many loops needs of this one. Times in seconds.");
        d.field("from", &Shape::from, number(), "First row.")
            .field("to", &Shape::to, number(), "Last row.")
            .field("dated", &Shape::dated, boolean(), "True: seconds since 1970; false: since t = 0.")
            .field("period", &Shape::period, number(), "Of the strongest oscillation; 0: none.")
            .field("spectrum", &Shape::spectrum, short_numbers(),
                   "Share of the error's power in bands even in the logarithm of the period, 1 s to 100,000 s.")
            .field("wave", &Shape::wave, short_numbers(), "The error's last periods, in standard deviations.")
            .field("wave_from", &Shape::wave_from, number(), "Time of its first value.")
            .field("wave_step", &Shape::wave_step, number(), "From value to value.")
            .field("set_point", &Shape::set_point, short_numbers(), "Means of even stretches, in standard deviations.")
            .field("output", &Shape::output, short_numbers(), "Means of even stretches, in standard deviations.");
        return d;
    }();
    return description;
}

const Description<Trend>& trend_contract() {
    static const auto description = [] {
        Description<Trend> d("LoopTrend", "The record as drawn.");
        d.field("t", &Trend::t, times_trace(), "Times.", {.unit = "time"})
            .field("y", &Trend::y, trace(), "Measurement.", {.unit = "y"})
            .field("r", &Trend::r, unless<std::vector<double>>(trace(), [](const auto& r) { return r.empty(); }),
                   "Set point.", {.unit = "y"})
            .field("u", &Trend::u, trace(), "Output.", {.unit = "u"});
        return d;
    }();
    return description;
}

const Description<Curve>& curve_contract() {
    static const auto description = [] {
        Description<Curve> d("CheckCurve", "A curve.");
        d.field("x", &Curve::x, times_trace(), "Periods or lags.", {.unit = "time"})
            .field("y", &Curve::y, trace(), "Shares of power, or correlations.");
        return d;
    }();
    return description;
}

}  // namespace

Codec<Verdict> check_verdict() {
    using enum Verdict;
    return choice<Verdict>({{"healthy", healthy},
                            {"stiction", stiction},
                            {"backlash", backlash},
                            {"tight", tight},
                            {"sluggish", sluggish},
                            {"external", external},
                            {"saturation", saturation},
                            {"quantised", quantised},
                            {"manual", manual},
                            {"frozen", frozen},
                            {"undetermined", undetermined},
                            {"insufficient-data", insufficient_data}});
}

Codec<ActionCode> check_action() {
    using enum ActionCode;
    return choice<ActionCode>({{"none", none},
                               {"retune", retune},
                               {"repair-valve", repair_valve},
                               {"find-source", find_source},
                               {"return-to-automatic", return_to_automatic},
                               {"check-range", check_range},
                               {"check-transmitter", check_transmitter},
                               {"record-again", record_again},
                               {"test", test}});
}

namespace {

/// The members of a loop's answer, but for those that are drawn of a single loop.
void add_findings(Description<CheckedLoop>& d) {
    using L = CheckedLoop;
    d.field("tag", &L::tag, words(), "Its name.")
        .field("quality", &L::quality, answer(quality_contract()), "The record; it comes before every diagnosis.")
        .field("service", &L::service, answer(service_contract()), "For what share of the time it was controlled.")
        .field("oscillation", &L::oscillation, answer(oscillation_contract()), "Whether the error oscillates.")
        .field("cause", &L::cause, answer(cause_contract()), "Why the loop is as it is.")
        .field("performance", &L::performance, answer(loop_performance_contract()), "How much error and output move.")
        .field("action", &L::action, answer(action_contract()), "What to do first.")
        .field("cure", &L::cure, only_answered(maybe(answer(cure_contract()))),
               "New settings, or the test that is missing, where tuning is the cause; settings until the repair of a "
               "sticking valve. Only if settings were asked for.")
        .field("weight", &L::weight, only_answered(maybe(number())), "As in the request.")
        .field("trend", &L::trend, answer(trend_contract()), "The whole record, as extremes of even stretches.");
}

}  // namespace

const Description<CheckedLoop>& loop_check_contract() {
    static const auto description = [] {
        using L = CheckedLoop;
        Description<L> d("LoopCheck", "What a loop's record says about it.");
        add_findings(d);
        d.field("excerpt", &L::excerpt, answer(trend_contract()), "Its last periods.")
            .field("spectrum", &L::spectrum, answer(curve_contract()), "Share of the error's power over the period.")
            .field("autocorrelation", &L::autocorrelation, answer(curve_contract()), "Of the error, over the lag.")
            .field("shape", &L::shape, object(shape_contract()), "For the judgement of many loops together.");
        return d;
    }();
    return description;
}

const Description<CheckedLoop>& loop_of_batch_contract() {
    static const auto description = [] {
        Description<CheckedLoop> d("LoopOfBatch", "What a loop's record says about it, in the judgement of a batch.");
        add_findings(d);
        d.field(
             "index", {}, [](const CheckedLoop&, Writer& out) { out.null(); }, integer(0, 1 << 30).schema,
             "Its entry in the batch, from 0.")
            .field(
                "job", {}, [](const CheckedLoop&, Writer& out) { out.null(); }, words().schema,
                "The job of the entry, whose result has the drawn parts too.")
            .field(
                "units", {}, [](const CheckedLoop&, Writer& out) { out.null(); }, object(units_contract()).schema,
                "Units of its answer, as in its request; left out if that has none.", {},
                [](const CheckedLoop&) { return true; });
        return d;
    }();
    return description;
}

namespace {

double number_in(const Json& object, const char* name) {
    const auto at = object.find(name);
    return at != object.end() && at->is_number() ? at->get<double>() : 0;
}

Figure figure_in(const Json& object, const char* name) {
    const auto at = object.find(name);
    if (at != object.end() && at->is_number()) return at->get<double>();
    return no_figure(object.value("why_null", Json::object()).value(name, ""));
}

void read_cause(const Json& from, Cause& cause, Reader& reader) {
    if (from.contains("verdict")) check_verdict().read(from["verdict"], cause.verdict, reader);
    if (from.contains("confidence")) confidence().read(from["confidence"], cause.confidence, reader);
    cause.size = figure_in(from, "size");
    cause.jump = figure_in(from, "jump");
    cause.period = figure_in(from, "period");
    cause.why_open = from.value("why_open", "");
    for (const Json& other : from.value("alternatives", Json::array())) {
        Verdict verdict = Verdict::undetermined;
        check_verdict().read(other, verdict, reader);
        cause.alternatives.push_back(verdict);
    }
    for (const Json& item : from.value("evidence", Json::array())) {
        Evidence evidence{item.value("code", ""), number_in(item, "value"), {}, item.value("detail", "")};
        if (item.contains("limit")) evidence.limit = number_in(item, "limit");
        cause.evidence.push_back(std::move(evidence));
    }
}

}  // namespace

check::LoopCheck read_loop_check(const Json& loop) {
    LoopCheck check;
    Reader reader;
    check.tag = loop.value("tag", "");
    if (loop.contains("weight")) check.weight = number_in(loop, "weight");
    const Json performance = loop.value("performance", Json::object());
    check.performance.mean_error = number_in(performance, "mean_error");
    check.performance.variability = number_in(performance, "variability");
    check.performance.independent = number_in(performance, "independent");
    check.performance.offset = number_in(performance, "offset");
    for (const Json& period : loop.value("/oscillation/periods"_json_pointer, Json::array())) {
        check.oscillation.found = true;
        check.oscillation.periods.push_back(
            {.period = number_in(period, "period"), .share = number_in(period, "share")});
    }
    read_cause(loop.value("cause", Json::object()), check.cause, reader);
    const Json action = loop.value("action", Json::object());
    if (action.contains("code")) check_action().read(action["code"], check.action.code, reader);
    if (action.contains("owner")) action_owner().read(action["owner"], check.action.owner, reader);
    check.action.detail = action.value("detail", "");
    if (loop.contains("shape")) shape_contract().read(loop["shape"], check.shape, reader);
    return check;
}

void write_cause_and_action(const check::LoopCheck& check, Writer& out) {
    out.key("cause");
    cause_contract().write(check.cause, out);
    out.key("action");
    action_contract().write(check.action, out);
}

}  // namespace tunewright::api
