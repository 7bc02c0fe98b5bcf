#include "api/contract/structure/cascade_call.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "engine/number_text.h"
#include "engine/structure/step_figures.h"

namespace tunewright::api {
namespace {

constexpr const char* kUnstableCascade = "The loops are not stable.";

const Description<CascadeLoop>& cascade_loop_contract() {
    static const auto description = [] {
        using L = CascadeLoop;
        Description<L> d("CascadeLoop", "One loop of a cascade.");
        d.field("plant", &L::plant, linear_plant(),
                "The inner plant is from the valve to the inner measurement, the outer one from there to the outer "
                "measurement; in a parallel cascade from the valve.")
            .field("record", &L::record, maybe(object(record_contract())),
                   "In place of the plant: a test that moves its input, which is u of the record, and its "
                   "measurement, y.")
            .field("tune", &L::tune, object(loop_design_contract()), "The design; not together with controller.")
            .field("controller", &L::controller, linear_controller(), "A controller to judge, in place of a design.")
            .check_presence([](const Json& value, L&, Reader& reader) {
                if (value.is_object() && value.contains("plant") && value.contains("record"))
                    reader.fault_at("record", "record and plant are both given; a loop has one. Remove one.");
                if (value.is_object() && value.contains("tune") && value.contains("controller"))
                    reader.fault_at("controller", "controller and tune are both given; a loop has one. Remove one.");
            });
        return d;
    }();
    return description;
}

const Description<CascadePair>& cascade_pair_contract() {
    static const auto description = [] {
        Description<CascadePair> d("CascadePair", "The controllers of both loops.");
        d.field("inner", &CascadePair::inner, linear_controller(), "Of the inner loop.", {.required = true})
            .field("outer", &CascadePair::outer, linear_controller(), "Of the outer loop.", {.required = true});
        return d;
    }();
    return description;
}

const auto& valve_limit_contract() {
    using L = decltype(CascadeRequest::limits);
    static const auto description = [] {
        Description<L> d("CascadeLimits", "Limits on both loops together.");
        d.field("Ms_valve", &L::Ms_valve, maybe(number({.exclusive_minimum = 1, .maximum = limits::kMaxMs})),
                "Limit on max |S| of the loop broken at the valve; default: " +
                    tunewright::text(structure::kDefaultValveOverLoops) + " times the larger Ms of both loops.");
        return d;
    }();
    return description;
}

const auto& weights_contract() {
    using W = decltype(CascadeRequest::weights);
    static const auto description = [] {
        const NumberRule rule{.minimum = 0};
        Description<W> d("CascadeWeights", "Weights of the IAE of a joint design.");
        d.field("d1", &W::d1, number(rule), "After a load at the outer plant's input.")
            .field("d2", &W::d2, number(rule), "After a load at the valve.")
            .check([](const Json&, W& weights, Reader& reader) {
                if (weights.d1 + weights.d2 == 0) reader.fault("d1 and d2 are both 0; one of them must be above 0.");
            });
        return d;
    }();
    return description;
}

/// A measurement as the input of a plant. Between samples it moves and is not held: their mean is nearest, held values
/// would be late by half a sample. A jump between values that stay is one of a held signal.
void as_input(std::vector<double>& measured) {
    const std::vector<double> samples = measured;
    const auto moves = [&](std::size_t k) { return k + 1 < samples.size() && samples[k] != samples[k + 1]; };
    for (std::size_t k = 0; k + 1 < samples.size(); ++k)
        if ((moves(k + 1) || (k > 0 && moves(k - 1))) && std::isfinite(samples[k + 1]))
            measured[k] = (samples[k] + samples[k + 1]) / 2;
}

/// One record of both plants: the inner one from u to d, the outer one from d to y, or from u in a parallel cascade.
void split_record(CascadeRequest& request) {
    NamedRecord outer = std::move(request.records.back());
    outer.name = "outer";
    NamedRecord inner = outer;
    inner.name = "inner";
    inner.read.record.y = inner.read.record.d.front().values;
    inner.read.record.y0 = {};
    if (request.arrangement == structure::Arrangement::series) {
        outer.read.record.u = outer.read.record.d.front().values;
        as_input(outer.read.record.u);
        outer.read.record.u0 = {};
        outer.read.record.u_limits = {};
    }
    for (NamedRecord* one : {&inner, &outer}) {
        one->read.record.d = {};
        one->read.record.r = {};
        one->read.record.automatic = {};
    }
    request.records = {std::move(inner), std::move(outer)};
}

void check_sources(CascadeRequest& request, Reader& reader) {
    if (request.record) {
        for (const auto& [name, loop] : {std::pair{"inner", &request.inner}, {"outer", &request.outer}})
            if (loop->plant || loop->record)
                reader.fault_at(name, std::string(name) +
                                          " has a plant or a record of its own, and record holds both "
                                          "loops. Remove one of them.");
        const Reader::At at(reader, "record");
        take_record(request, "", "record", std::move(*request.record), 1,
                    "The record of a cascade needs one further column or signal, d: the measurement of the inner loop, "
                    "such as columns {\"u\": \"FIC7.OP\", \"d\": [\"FIC7.PV\"], \"y\": \"TIC101.PV\"}.",
                    reader);
        if (!request.records.empty()) split_record(request);
        return;
    }
    for (auto& [name, loop] : {std::pair{"inner", &request.inner}, {"outer", &request.outer}}) {
        const Reader::At at(reader, name);
        if (!loop->plant && !loop->record) {
            reader.fault_at("plant", "plant is missing. Give the plant, such as \"2 e^(-s)/(4s+1)\", or a record.");
            continue;
        }
        if (loop->plant) continue;
        const Reader::At record(reader, "record");
        take_record(request, name, std::string(name) + "/record", std::move(*loop->record), 0,
                    "The record of one loop needs u and y alone. Leave out d.", reader);
    }
    if (request.arrangement != structure::Arrangement::series) return;
    for (NamedRecord& one : request.records)
        if (one.name == "outer") as_input(one.read.record.u);
}

void check_cascade(const Json& value, CascadeRequest& request, Reader& reader) {
    check_sources(request, reader);
    if (request.joint && (request.inner.controller || request.outer.controller))
        reader.fault_at("search",
                        "search is joint, which designs both controllers, and one is given. Remove controller, or "
                        "take search sequential.");
    if (value.contains("weights") && !request.joint)
        reader.fault_at("weights", "weights belong to search joint. Remove them, or set search to joint.");
}

// The loops of an answer, each from the whole of it.
enum class Side { inner, outer };

void write_loop(const CascadeAnswer& answer, Side side, Writer& out) {
    const structure::CascadeFigures& f = answer.result.figures;
    const std::string why = f.stable ? "" : kUnstableCascade;
    out.begin_object();
    out.key("controller");
    ideal_controller().write(side == Side::inner ? answer.result.controllers.inner : answer.result.controllers.outer,
                             out);
    out.key("robustness");
    if (side == Side::inner) {
        write_figures(out, {{"Ms", known_unless(f.Ms_inner, why)}, {"Mt", known_unless(f.Mt_inner, why)}});
    } else {
        const auto margin = [&](double value, const char* none) {
            return why.empty() ? finite_or(value, none) : no_figure(why);
        };
        write_figures(
            out, {{"Ms", known_unless(f.Ms_outer, why)},
                  {"Mt", known_unless(f.Mt_outer, why)},
                  {"Ms_valve", known_unless(f.Ms_valve, why)},
                  {"gain_margin", margin(f.outer_margins.gain_margin, "No gain makes it unstable.")},
                  {"phase_margin_deg",
                   margin(f.outer_margins.phase_margin * 180 / std::numbers::pi, "The loop has no gain crossover.")},
                  {"dead_time_up", margin(f.outer_margins.delay_margin, "No later dead time makes it unstable.")}});
    }
    out.end_object();
}

SchemaOf loop_schema(Side side) {
    return [side](SchemaBook& book) {
        return Json{{"type", "object"},
                    {"properties",
                     {{"controller", ideal_controller().schema(book)},
                      {"robustness", side == Side::inner ? figures_schema({"Ms", "Mt"})
                                                         : figures_schema({"Ms", "Mt", "Ms_valve", "gain_margin",
                                                                           "phase_margin_deg", "dead_time_up"})}}},
                    {"required", {"controller", "robustness"}}};
    };
}

StepView view_of(const structure::LoadFigures& f, const std::string& why) { return {f.IAE, f.IE, f.peak, f.TV, why}; }

void write_steps(const structure::LoadFigures& inner, const structure::LoadFigures& outer,
                 const structure::LoadFigures& setpoint, bool stable, Writer& out) {
    const std::string why = stable ? "" : kUnstableCascade;
    out.begin_object();
    out.key("inner_load");
    step_view_contract().write(view_of(inner, why), out);
    out.key("outer_load");
    step_view_contract().write(view_of(outer, why), out);
    out.key("setpoint");
    step_view_contract().write(view_of(setpoint, why), out);
    out.end_object();
}

Json steps_schema(SchemaBook& book) {
    const Json step = step_view_contract().schema(book);
    return {{"type", "object"},
            {"properties", {{"inner_load", step}, {"outer_load", step}, {"setpoint", step}}},
            {"required", {"inner_load", "outer_load", "setpoint"}}};
}

const Description<structure::SingleLoop>& single_loop_contract() {
    static const auto description = [] {
        using S = structure::SingleLoop;
        Description<S> d("SingleLoop", "One controller in place of the cascade, by the method robust.");
        d.field("controller", &S::controller, ideal_controller(), "From the outer measurement to the valve.")
            .field("Ms", &S::Ms, peak_figure(), "Its max |S|.")
            .field("Mt", &S::Mt, peak_figure(), "Its max |T|.")
            .field(
                "performance", {},
                [](const S& s, Writer& out) { write_steps(s.inner_load, s.outer_load, s.setpoint, s.stable, out); },
                steps_schema, "Figures of the outer measurement.")
            .why_null("The loop is not stable.");
        return d;
    }();
    return description;
}

const Description<structure::CascadeFigures>& baseline_contract() {
    static const auto description = [] {
        using F = structure::CascadeFigures;
        Description<F> d("CascadeBaseline", "Figures of the controllers in use.");
        d.field("stable", &F::stable, only_answered(boolean()), "Both loops are stable.")
            .field(
                "robustness", {},
                [](const F& f, Writer& out) {
                    const std::string why = f.stable ? "" : kUnstableCascade;
                    write_figures(out, {{"Ms_inner", known_unless(f.Ms_inner, why)},
                                        {"Ms_outer", known_unless(f.Ms_outer, why)},
                                        {"Ms_valve", known_unless(f.Ms_valve, why)}});
                },
                [](SchemaBook&) {
                    return figures_schema({"Ms_inner", "Ms_outer", "Ms_valve"});
                },
                "The three peaks.")
            .field(
                "performance", {},
                [](const F& f, Writer& out) { write_steps(f.inner_load, f.outer_load, f.setpoint, f.stable, out); },
                steps_schema, "Figures of the outer measurement.");
        return d;
    }();
    return description;
}

/// IAE with a single loop over that of the cascade.
Figure gain_of(const CascadeAnswer& a, structure::LoadFigures structure::SingleLoop::*single,
               structure::LoadFigures structure::CascadeFigures::*cascade) {
    if (!a.single) return no_figure(a.single.why);
    if (!a.single->stable || !a.result.figures.stable) return no_figure(kUnstableCascade);
    return structure::ratio(((*a.single).*single).IAE, (a.result.figures.*cascade).IAE);
}

}  // namespace

structure::CascadeDesign CascadeRequest::design() const {
    return {.inner = inner.tune,
            .outer = outer.tune,
            .given_inner = inner.controller,
            .Ms_valve = limits.Ms_valve,
            .joint = joint,
            .weight_outer = weights.d1,
            .weight_inner = weights.d2};
}

const Description<CascadeRequest>& cascade_request_contract() {
    static const auto description = [] {
        using R = CascadeRequest;
        using enum structure::Arrangement;
        Description<R> d("CascadeRequest", "Two controllers in series: design or judgement.");
        add_structure_members(d, "cascade", 2);
        d.field("inner", &R::inner, object(cascade_loop_contract()), "The inner loop.")
            .field("outer", &R::outer, object(cascade_loop_contract()), "The outer loop.")
            .field("record", &R::record, maybe(object(record_contract())),
                   "In place of both plants: one test that moves u, with the inner measurement as d and the outer one "
                   "as y.")
            .field("arrangement", &R::arrangement,
                   choice<structure::Arrangement>({{"series", series}, {"parallel", parallel}}),
                   "series: the outer plant follows the inner measurement; parallel: the valve moves both.")
            .field("limits", &R::limits, object(valve_limit_contract()), "Limits on both loops together.")
            .field("search", &R::joint, choice<bool>({{"sequential", false}, {"joint", true}}),
                   "sequential: the inner loop, then the outer one; joint: then all settings at once.")
            .field("weights", &R::weights, object(weights_contract()), "For search joint: the weights of the IAE.")
            .field("baseline", &R::baseline, maybe(object(cascade_pair_contract())), "The controllers in use.")
            .field("compare_single", &R::compare_single, boolean(),
                   "Also design one controller without the inner loop.")
            .check(check_cascade)
            .example({{"inner", {{"plant", "2 e^(-s)/(4s+1)"}}}, {"outer", {{"plant", "1.5 e^(-8s)/(30s+1)"}}}});
        return d;
    }();
    return description;
}

const Description<CascadeAnswer>& cascade_answer_contract() {
    static const auto description = [] {
        using A = CascadeAnswer;
        Description<A> d("CascadeAnswer", "Controllers of a cascade and their figures.");
        add_structure_name(d, "cascade");
        d.field(
             "inner", {}, [](const A& a, Writer& out) { write_loop(a, Side::inner, out); }, loop_schema(Side::inner),
             "The inner loop with the outer one in manual.")
            .field(
                "outer", {}, [](const A& a, Writer& out) { write_loop(a, Side::outer, out); }, loop_schema(Side::outer),
                "The outer loop with the inner one closed; Ms_valve: both, broken at the valve.")
            .field("Ms_valve_limit", &A::limit_valve, only_answered(number()), "The limit on Ms_valve.")
            .field(
                "performance", {},
                [](const A& a, Writer& out) {
                    const auto& f = a.result.figures;
                    write_steps(f.inner_load, f.outer_load, f.setpoint, f.stable, out);
                },
                steps_schema,
                "Figures of the outer measurement after unit steps of a load at the valve, of a load at the outer "
                "plant's input, and of the set point; TV of the valve.")
            .field("speed_ratio", &A::result,
                   computed_figure<structure::CascadeResult>(
                       [](const structure::CascadeResult& r) { return r.figures.speed_ratio; }),
                   "Gain crossover of the inner over that of the outer loop; null without one.")
            .field("single", &A::single, or_reason(answer(single_loop_contract())),
                   "One controller without inner loop.")
            .field(
                "gain", {},
                [](const A& a, Writer& out) {
                    write_figures(
                        out, {{"inner_load",
                               gain_of(a, &structure::SingleLoop::inner_load, &structure::CascadeFigures::inner_load)},
                              {"outer_load",
                               gain_of(a, &structure::SingleLoop::outer_load, &structure::CascadeFigures::outer_load)},
                              {"setpoint",
                               gain_of(a, &structure::SingleLoop::setpoint, &structure::CascadeFigures::setpoint)}});
                },
                [](SchemaBook&) {
                    return figures_schema({"inner_load", "outer_load", "setpoint"});
                },
                "IAE of the single loop over that of the cascade.")
            .field("baseline", &A::baseline, maybe(answer(baseline_contract())), "The controllers in use.")
            .why_null("Not computed.");
        add_answer_members(d);
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
