#include "api/contract/own_step.h"

#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

constexpr const char* kNoFigure = "Not defined for this step.";

/// True: at the plant's output.
const Codec<bool>& place() {
    static const Codec<bool> codec = choice<bool>({{"input", false}, {"output", true}});
    return codec;
}

const Description<OwnStep::Load>& load_contract() {
    static const auto description = [] {
        using L = OwnStep::Load;
        Description<L> d("OwnLoad", "A load that follows the set point.");
        d.field("size", &L::size, number({.not_zero = true}),
                "Its size: in the unit of u at the plant's input, in the unit of y at its output.", {.required = true})
            .field(
                "at", [](const Json& value, L& load, Reader& reader) { place().read(value, load.at_output, reader); },
                [](const L& load, Writer& out) { place().write(load.at_output, out); },
                [](SchemaBook& book) { return place().schema(book); },
                "input: it adds to u, before the dead time. output: it adds to y.")
            .field(
                "shape", &L::shape,
                choice<LoadShape>({{"step", LoadShape::step}, {"pulse", LoadShape::pulse}, {"ramp", LoadShape::ramp}}),
                "step: it stays. pulse: it ends after `duration`. ramp: it rises over `duration`, then it stays.")
            .field("duration", &L::duration, maybe(number({.exclusive_minimum = 0})),
                   "Length of a pulse or a ramp, > 0; both need it.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<OwnSetpointFigures>& setpoint_figures_contract() {
    static const auto description = [] {
        using F = OwnSetpointFigures;
        Description<F> d("OwnSetpointFigures", "Figures of the set point's part, up to the load.");
        d.field("IAE", &F::IAE, figure(), "Integral of |r - y|, where r is the set point as it rises.",
                {.unit = "y time"})
            .field("overshoot", &F::overshoot, figure(), "Overshoot of y over the target.", {.unit = "y"})
            .field("overshoot_percent", &F::overshoot_percent, figure(), "The same in percent of the step.",
                   {.unit = "%"})
            .field("settling_time", &F::settling_time, figure(),
                   "Last time before the load at which y is farther from the target than 2 % of the step.",
                   {.unit = "time"})
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<OwnLoadFigures>& load_figures_contract() {
    static const auto description = [] {
        using F = OwnLoadFigures;
        Description<F> d("OwnLoadFigures", "Figures of the load's part.");
        d.field("start", &F::start, only_answered(number()), "Time at which the load begins.", {.unit = "time"})
            .field("IAE", &F::IAE, figure(), "Integral of |r - y| from there on.", {.unit = "y time"})
            .field("peak", &F::peak, figure(), "Largest deviation of y from the target, signed.", {.unit = "y"})
            .field("recovery_time", &F::recovery_time, figure(),
                   "Last time from `start` at which the deviation exceeds 2 % of the peak.", {.unit = "time"})
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<OwnStepTrace>& trace_contract() {
    static const auto description = [] {
        using T = OwnStepTrace;
        Description<T> d("OwnStepTrace", "Values themselves, not deviations; six significant digits.");
        d.field("t", &T::t, abscissa(), "Time from the step.", {.unit = "time"})
            .field("r", &T::r, trace(), "Set point.", {.unit = "y"})
            .field("y", &T::y, trace(), "Measurement.", {.unit = "y"})
            .field("u", &T::u, trace(), "Controller output, within its limits.", {.unit = "u"});
        return d;
    }();
    return description;
}

bool refused(const OwnStepEntry& entry) { return entry.refused.has_value(); }

void add_refusal(Description<OwnStepEntry>& d) {
    using enum OwnStepRefusal;
    Json codes = Json::array();
    for (const OwnStepRefusal refusal : {no_time, equations, no_law, unstable, impulse})
        codes.push_back(name_of(refusal));
    d.field(
        "refused", {},
        [](const OwnStepEntry& entry, Writer& out) {
            out.begin_object();
            out.key("code");
            out.text(name_of(*entry.refused));
            out.key("text");
            out.text(reason_of(*entry.refused));
            out.end_object();
        },
        [codes](SchemaBook&) {
            return Json{
                {"type", "object"},
                {"properties", {{"code", {{"type", "string"}, {"enum", codes}}}, {"text", {{"type", "string"}}}}},
                {"required", {"code", "text"}}};
        },
        "Reason why the step is not simulated, and the cure; everything else is then left out.", {},
        [](const OwnStepEntry& entry) { return !entry.refused; });
}

/// A member that a refused step leaves out.
template <class T>
void add(Description<OwnStepEntry>& d, const char* name, T OwnStepEntry::*member, Codec<T> codec, const char* sentence,
         FieldOptions options = {}) {
    d.field(
        name, {}, [member, codec](const OwnStepEntry& entry, Writer& out) { codec.write(entry.*member, out); },
        codec.schema, sentence, options, refused);
}

}  // namespace

const Description<OwnStep>& own_step_contract() {
    static const auto description = [] {
        Description<OwnStep> d("OwnStep",
                               "The user's own step, in the units of y and u instead of deviations: from rest at `y` "
                               "and `u` the set point goes to `target`, and a load follows.");
        const auto time = maybe(number({.exclusive_minimum = 0}));
        d.field("y", &OwnStep::y, number(), "Measurement and set point at rest before the step.", {.unit = "y"})
            .field("u", &OwnStep::u, number(), "Controller output at that rest.", {.unit = "u"})
            .field("target", &OwnStep::target, number(), "The new set point.", {.required = true, .unit = "y"})
            .field("u_min", &OwnStep::u_min, maybe(number()), "Lower limit of u; left out: none.", {.unit = "u"})
            .field("u_max", &OwnStep::u_max, maybe(number()), "Upper limit of u; left out: none.", {.unit = "u"})
            .field("ramp_rate", &OwnStep::ramp_rate, time, "Rate at which the set point moves; left out: at once.",
                   {.unit = "y/time"})
            .field("hold", &OwnStep::hold, maybe(number({.minimum = 0})),
                   "Time from the end of the ramp to the load; left out: until the slowest entry rests, at most three "
                   "times the shortest.",
                   {.unit = "time"})
            .field("load", &OwnStep::load, maybe(object(load_contract())), "The load; left out: none.")
            .field("length", &OwnStep::length, time, "Time that is simulated; left out: until the loop rests.",
                   {.unit = "time"})
            .check([](const Json&, OwnStep& step, Reader& reader) {
                const std::string place = "evaluate/own_step/";
                if (const auto fault = refuse_own_step(step))
                    reader.fault_below(fault->where.substr(place.size()), 0, fault->message);
            })
            .example({{"y", 20}, {"u", 5}, {"target", 200}, {"u_min", 0}, {"u_max", 100}});
        return d;
    }();
    return description;
}

const Description<OwnStepEntry>& own_step_entry_contract() {
    static const auto description = [] {
        using E = OwnStepEntry;
        Description<E> d("OwnStepEntry",
                         "The user's own step with this controller: with `implement` as the user's controller computes "
                         "it, else the continuous one with back-calculation.");
        add_refusal(d);
        d.field("setpoint", &E::setpoint, maybe(answer(setpoint_figures_contract())),
                "Left out if the set point does not move.")
            .field("load", &E::load, maybe(answer(load_figures_contract())), "Left out without a load.");
        add(d, "u_min", &E::u_min, number(), "Smallest u.", {.unit = "u"});
        add(d, "u_max", &E::u_max, number(), "Largest u.", {.unit = "u"});
        add(d, "travel", &E::travel, number(), "Total variation of u.", {.unit = "u"});
        add(d, "time_at_min", &E::time_at_min, figure(), "Time that u spends at its lower limit.", {.unit = "time"});
        add(d, "time_at_max", &E::time_at_max, figure(), "Time that u spends at its upper limit.", {.unit = "time"});
        add(d, "u_needed", &E::u_needed, figure(),
            "u that holds the target in the end. Beyond a limit the target is out of reach.", {.unit = "u"});
        add(d, "y_final", &E::y_final, figure(), "y at rest in the end.", {.unit = "y"});
        d.field(
            "why_null", {},
            [](const E& entry, Writer& out) {
                out.begin_object();
                for (const auto& [name, value] : {std::pair("time_at_min", &entry.time_at_min),
                                                  {"time_at_max", &entry.time_at_max},
                                                  {"u_needed", &entry.u_needed},
                                                  {"y_final", &entry.y_final}})
                    if (!*value) out.key(name).text(value->why.empty() ? kNoFigure : value->why);
                out.end_object();
            },
            [](SchemaBook&) {
                return Json{{"type", "object"}, {"additionalProperties", {{"type", "string"}}}};
            },
            "The reason for each figure that is null.", {},
            [](const E& entry) {
                return refused(entry) || (entry.time_at_min && entry.time_at_max && entry.u_needed && entry.y_final);
            });
        add(d, "settles", &E::settles, Codec<bool>{{}, boolean().write, boolean().schema},
            "False: the simulation ends before the loop rests.");
        d.field("trace", &E::trace, maybe(answer(trace_contract())), "Left out with points 0.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
