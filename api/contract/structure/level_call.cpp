#include "api/contract/structure/level_call.h"

namespace tunewright::api {
namespace {

using structure::LevelDesign;
using structure::LevelProblem;

const NumberRule kAboveZero{.exclusive_minimum = 0};

const Description<structure::FlowLoop>& flow_loop_contract() {
    static const auto description = [] {
        using F = structure::FlowLoop;
        Description<F> d("FlowLoop", "The closed loop of the outflow.");
        d.field("T", &F::T, number({.minimum = 0}), "Its lag.", {.unit = "time"})
            .field("L", &F::L, number({.minimum = 0}), "Its dead time.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<structure::LevelSettings>& level_settings_contract() {
    static const auto description = [] {
        using S = structure::LevelSettings;
        Description<S> d("LevelSettings", "A level controller.");
        d.field("Kc", &S::Kc, number(kAboveZero), "Gain: flow per level.", {.required = true, .unit = "u/y"})
            .field("Ti", &S::Ti, maybe(number(kAboveZero)), "Integral time; left out: proportional action alone.",
                   {.unit = "time"});
        return d;
    }();
    return description;
}

/// A member of the problem.
template <class M>
Callable<void(const Json&, LevelRequest&, Reader&)> into(M LevelProblem::*member, const Codec<M>& codec) {
    return [member, read = codec.read](const Json& value, LevelRequest& request, Reader& reader) {
        read(value, request.problem.*member, reader);
    };
}

void check_level(const Json& value, LevelRequest& request, Reader& reader) {
    const LevelProblem& p = request.problem;
    if (value.contains("zeta") && p.aim != structure::LevelAim::zeta)
        reader.fault_at("zeta", "zeta belongs to the aim zeta. Set aim to zeta, or remove it.");
    if (p.aim == structure::LevelAim::zeta && !value.contains("zeta") && !p.given)
        reader.fault_at("zeta", "zeta is missing; the aim zeta needs the damping, such as 0.7.");
    if (value.contains("aim") && p.given)
        reader.fault_at("aim", "aim belongs to a design, and controller is given. Remove one of them.");
}

/// A number of every design; time and Ti are infinite without integral action.
Description<LevelDesign>& add_design(Description<LevelDesign>& d) {
    using L = LevelDesign;
    const Codec<double> finite = finite_figure("");
    return d.field("Kc", &L::Kc, finite, "Gain: flow per level.", {.unit = "u/y"})
        .field("Ti", &L::Ti, finite_figure("There is no integral action."),
               "Integral time; null: proportional action alone.", {.unit = "time"})
        .field("zeta", &L::zeta, finite, "Damping; 0 without integral action.")
        .field("highest", &L::highest, finite, "The highest level after the largest step.", {.unit = "y"})
        .field("time_of_highest", &L::time_of_highest,
               finite_figure("The level approaches its highest value without end."),
               "Its time; null: the level approaches it without end.", {.unit = "time"})
        .field("largest_rate", &L::largest_rate, finite, "The largest rate of the outflow.", {.unit = "u/time"})
        .field("rate_over_bound", &L::rate_over_bound, finite, "It over the bound for any controller.")
        .field("overshoot_percent", &L::overshoot_percent, finite, "Overshoot of the outflow in percent of the step.",
               {.unit = "%"})
        .why_null("It is infinite.");
}

const Description<LevelDesign>& level_design_contract() {
    static const auto description = [] {
        Description<LevelDesign> d("LevelDesign", "A level controller and what it does after the largest step.");
        add_design(d);
        return d;
    }();
    return description;
}

}  // namespace

const Description<LevelRequest>& level_request_contract() {
    static const auto description = [] {
        using R = LevelRequest;
        using enum structure::LevelAim;
        const Codec<double> positive = number(kAboveZero);
        const auto flow = maybe(object(flow_loop_contract()));
        const auto given = maybe(object(level_settings_contract()));
        const auto aim = choice<structure::LevelAim>(
            {{"rate", rate}, {"no_outflow_overshoot", no_overshoot}, {"zeta", structure::LevelAim::zeta}});
        Description<R> d("LevelRequest",
                         "A level that smooths flows: a vessel, its largest step, the room of the level.");
        add_structure_members(d, "level", 1);
        d.field("volume", into(&LevelProblem::area, positive), {}, positive.schema,
                "Volume per unit of level, in the units of flow, time and level.",
                {.required = true, .unit = "u time/y"})
            .field("largest_step", into(&LevelProblem::step, positive), {}, positive.schema,
                   "The largest step of the inflow.", {.required = true, .unit = "u"})
            .field("allowed", into(&LevelProblem::allowed, positive), {}, positive.schema,
                   "The largest deviation of the level that is allowed.", {.required = true, .unit = "y"})
            .field("aim", into(&LevelProblem::aim, aim), {}, aim.schema,
                   "rate (default): the lowest rate of the outflow, zeta = 0.4; no_outflow_overshoot: proportional "
                   "action alone; zeta: a given damping.")
            .field("zeta", into(&LevelProblem::zeta, positive), {}, positive.schema, "The damping of the aim zeta.")
            .field("gap", into(&LevelProblem::gap, number({.minimum = 0})), {}, number({.minimum = 0}).schema,
                   "Deviation within which proportional action alone rests; default 0.", {.unit = "y"})
            .field("flow_loop", into(&LevelProblem::flow, flow), {}, flow.schema, "The closed loop of the outflow.")
            .field("controller", into(&LevelProblem::given, given), {}, given.schema,
                   "A controller to judge, in place of a design.")
            .check(check_level)
            .example({{"volume", 12}, {"largest_step", 4}, {"allowed", 1.8}});
        return d;
    }();
    return description;
}

const Description<LevelAnswer>& level_answer_contract() {
    static const auto description = [] {
        using A = LevelAnswer;
        Description<A> d("LevelAnswer", "A level controller, its figures, and other dampings.");
        add_structure_name(d, "level");
        d.field(
             "design", {}, [](const A& a, Writer& out) { level_design_contract().write(a.result.design, out); },
             [](SchemaBook& book) { return level_design_contract().schema(book); }, "The controller.")
            .field(
                "gap", {}, [](const A& a, Writer& out) { out.number(a.gap); }, number().schema,
                "Deviation within which the controller rests.", {.unit = "y"}, [](const A& a) { return a.gap == 0; })
            .field("bound", {}, [](const A& a, Writer& out) { out.number(a.result.bound); }, number().schema,
                   "The rate of the outflow that no controller undercuts which keeps the level in its room.",
                   {.unit = "u/time"})
            .field(
                "robustness", {},
                [](const A& a, Writer& out) {
                    write_figures(
                        out,
                        {{"Ms", a.result.Ms}, {"highest", a.result.highest}, {"largest_rate", a.result.largest_rate}});
                },
                [](SchemaBook&) {
                    return figures_schema({"Ms", "highest", "largest_rate"});
                },
                "With the flow loop, from a simulation: the highest level and the largest rate of the outflow.")
            .field(
                "frontier", {},
                [](const A& a, Writer& out) { list_of(answer(level_design_contract())).write(a.result.frontier, out); },
                list_of(answer(level_design_contract())).schema,
                "Designs over the damping, then proportional action alone; each uses the whole room.");
        add_answer_members(d);
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
