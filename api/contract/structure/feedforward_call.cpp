#include "api/contract/structure/feedforward_call.h"

#include <initializer_list>
#include <utility>
#include <vector>

namespace tunewright::api {
namespace {

using structure::Feedforward;
using structure::FeedforwardVariant;

const Description<Feedforward>& compensator_contract() {
    static const auto description = [] {
        using F = Feedforward;
        const NumberRule time{.minimum = 0};
        Description<F> d("Feedforward", "F = Kf (Tz s + 1)/(Tp s + 1) e^(-Lf s), subtracted from u.");
        d.field("Kf", &F::Kf, number(), "Gain: u per unit of the disturbance.", {.required = true})
            .field("Tz", &F::Tz, number(time), "Lead.", {.unit = "time"})
            .field("Tp", &F::Tp, number(time), "Lag.", {.unit = "time"})
            .field("Lf", &F::Lf, number(time), "Delay.", {.unit = "time"})
            .check([](const Json&, F& f, Reader& reader) {
                if (f.Tz > 0 && f.Tp == 0)
                    reader.fault_at("Tp", "Tp is 0 with a lead Tz of " + shown(f.Tz) +
                                              "; such a compensator cannot be built. Give a lag, such as Tz/10.");
            });
        return d;
    }();
    return description;
}

Words<structure::FeedforwardKind> kind_words(std::initializer_list<structure::FeedforwardKind> kinds) {
    Words<structure::FeedforwardKind> words;
    for (const auto kind : kinds) words.emplace_back(name_of(kind), kind);
    return words;
}

const auto& feedforward_wish_contract() {
    using W = decltype(FeedforwardRequest::feedforward);
    static const auto description = [] {
        using enum structure::FeedforwardKind;
        Description<W> d("FeedforwardWish", "Limits of the compensator.");
        d.field("jump", &W::jump, number({.exclusive_minimum = 0}),
                "The largest first move of u after a unit step of the disturbance.")
            .field("method", &W::method, choice<structure::FeedforwardKind>(kind_words({gain, inverse, rule, optimum})),
                   "Which of the designs the conclusions and the program are about; all of them are answered.")
            .field(
                "form",
                [](const Json& value, W&, Reader& reader) {
                    if (value != "lead_lag") reader.fault("form is " + shown(value) + "; only lead_lag is supported.");
                },
                {},
                [](SchemaBook&) {
                    return Json{{"const", "lead_lag"}, {"default", "lead_lag"}};
                },
                "A lead, a lag and a dead time.");
        return d;
    }();
    return description;
}

void check_given(const Json& value, const FeedforwardRequest& request, Reader& reader) {
    if (request.controller && value.contains("feedforward"))
        reader.fault_at("feedforward", "feedforward belongs to designs, and controller is given. Remove one of them.");
}

void check_paths(FeedforwardRequest& request, Reader& reader) {
    if (!request.record) {
        for (const auto& [name, plant] : {std::pair{"plant", &request.plant}, {"disturbance", &request.disturbance}})
            if (!*plant)
                reader.fault_at(name,
                                std::string(name) +
                                    " is missing. Give it, such as \"1.5 e^(-15s)/(60s+1)\", or a record in which "
                                    "u and the disturbance move.");
        return;
    }
    if (request.plant || request.disturbance)
        return reader.fault_at("record", "record stands for plant and disturbance. Give it, or both of them.");
    const Reader::At at(reader, "record");
    take_record(request, "plant", "record", std::move(*request.record), 1,
                "The record needs one further column or signal, d: the measured disturbance, such as columns {\"u\": "
                "\"OP\", \"d\": [\"feed\"], \"y\": \"PV\"}.",
                reader);
}

/// A controller's members, or {"tune": {...}}.
Codec<FeedbackWish> feedback_codec() {
    const auto given = linear_controller();
    Codec<FeedbackWish> codec;
    codec.read = [given](const Json& value, FeedbackWish& target, Reader& reader) {
        if (!value.is_object() || !value.contains("tune")) return given.read(value, target.controller, reader);
        if (value.size() > 1)
            return reader.fault_at("tune", "tune stands alone in feedback. Remove the other members, or remove tune.");
        const Reader::At at(reader, "tune");
        loop_design_contract().read(value["tune"], target.tune.emplace(), reader);
    };
    codec.schema = [given](SchemaBook& book) {
        return Json{{"oneOf", Json::array({given.schema(book),
                                           Json{{"type", "object"},
                                                {"properties", {{"tune", loop_design_contract().schema(book)}}},
                                                {"required", {"tune"}},
                                                {"additionalProperties", false}}})}};
    };
    codec.skip = [](const FeedbackWish&) { return true; };
    return codec;
}

struct WrongCase {
    const char* name;
    std::size_t at;
};
constexpr WrongCase kWrongCases[] = {{"disturbance_gain_low", 0},
                                     {"disturbance_gain_high", 1},
                                     {"plant_dead_time_short", 2},
                                     {"plant_dead_time_long", 3}};

void write_wrong(const FeedforwardVariant& v, Writer& out) {
    std::vector<std::pair<std::string, Figure>> figures;
    for (const WrongCase& one : kWrongCases) figures.emplace_back(one.name, v.IAE_if_wrong[one.at]);
    write_figures(out, figures);
}

Codec<std::optional<Feedforward>> compensator_or_null() {
    Codec<std::optional<Feedforward>> codec;
    codec.write = [](const std::optional<Feedforward>& f, Writer& out) {
        f ? compensator_contract().write(*f, out) : out.null();
    };
    codec.schema = or_null(object(compensator_contract()).schema);
    codec.undefined = [](const std::optional<Feedforward>& f) { return !f; };
    return codec;
}

const Description<FeedforwardVariant>& variant_contract() {
    static const auto description = [] {
        using V = FeedforwardVariant;
        using enum structure::FeedforwardKind;
        using S = structure::StepFigures;
        const auto figure_of = [](auto S::*member) {
            return computed_figure<S>([member](const S& s) { return s.settles ? Figure(s.*member) : s.IAE; });
        };
        Description<V> d("FeedforwardVariant", "A compensator and its figures after a unit step of the disturbance.");
        d.field(
             "kind", &V::kind,
             only_answered(choice<structure::FeedforwardKind>(kind_words({none, gain, inverse, rule, optimum, given}))),
             "none: feedback alone; static: the gain alone; inverse: lead, lag and delay of both plants; "
             "guzman_hagglund: the rule of 2011; optimum: the least IAE.")
            .field("compensator", &V::compensator, compensator_or_null(),
                   "Null without one, and if it cannot be built.")
            .field("IAE", &V::figures, figure_of(&S::IAE), "Integral of the error's magnitude.")
            .field("IE", &V::figures, figure_of(&S::IE), "Integral of the error.")
            .field("peak", &V::figures, figure_of(&S::peak), "y farthest from 0.")
            .field("TV", &V::figures, figure_of(&S::TV), "Total variation of u.")
            .field("u_start", &V::u_start, only_answered(number()), "First move of u.")
            .field(
                "IAE_if_wrong", {}, write_wrong,
                [](SchemaBook&) {
                    return figures_schema({"disturbance_gain_low", "disturbance_gain_high", "plant_dead_time_short",
                                           "plant_dead_time_long"});
                },
                "IAE if the disturbance's gain or the plant's dead time differs by `uncertainty`.", {},
                [](const V& v) { return v.IAE_if_wrong.empty(); })
            .field("why_not", &V::why_not, unless<std::string>(words(), [](const auto& text) { return text.empty(); }),
                   "Why it cannot be built.")
            .why_null("There is no compensator.");
        return d;
    }();
    return description;
}

}  // namespace

const Description<FeedforwardRequest>& feedforward_request_contract() {
    static const auto description = [] {
        using R = FeedforwardRequest;
        Description<R> d("FeedforwardRequest", "A loop with feedback, and a disturbance that is measured.");
        add_structure_members(d, "feedforward", 1);
        d.field("plant", &R::plant, linear_plant(), "From u to y.")
            .field("disturbance", &R::disturbance, linear_plant(), "From the measured disturbance to y.")
            .field("record", &R::record, maybe(object(record_contract())),
                   "In place of both: a record in which u and the disturbance, d, move.")
            .field("feedback", &R::feedback, feedback_codec(),
                   "The loop's controller, or tune with the limits of a design.", {.required = true})
            .field("feedforward", &R::feedforward, object(feedforward_wish_contract()), "Limits of the compensator.")
            .field("controller", &R::controller, maybe(object(compensator_contract())),
                   "A compensator to judge, in place of designs.")
            .field("uncertainty", &R::uncertainty, number({.exclusive_minimum = 0, .exclusive_maximum = 1}),
                   "Share by which the disturbance's gain and the plant's dead time are taken to be wrong.")
            .check([](const Json& value, R& request, Reader& reader) {
                check_given(value, request, reader);
                check_paths(request, reader);
            })
            .example({{"plant", "1.5 e^(-15s)/(60s+1)"},
                      {"disturbance", "1/(15s+1)"},
                      {"feedback", {{"Kp", 1.3333}, {"Ti", 60}}},
                      {"feedforward", {{"jump", 12}}}});
        return d;
    }();
    return description;
}

const Description<FeedforwardAnswer>& feedforward_answer_contract() {
    static const auto description = [] {
        using A = FeedforwardAnswer;
        Description<A> d("FeedforwardAnswer", "Compensators and their figures with the feedback in place.");
        add_structure_name(d, "feedforward");
        d.field("feedback", &A::feedback, ideal_controller(), "The loop's controller.")
            .field(
                "variants", {},
                [](const A& a, Writer& out) { list_of(answer(variant_contract())).write(a.result.variants, out); },
                list_of(answer(variant_contract())).schema, "Without feedforward, then the compensators.")
            .field(
                "chosen", {}, [](const A& a, Writer& out) { out.text(name_of(a.chosen)); }, words().schema,
                "The variant that the conclusions and the program are about.")
            .field("late", {}, [](const A& a, Writer& out) { out.number(a.result.late); }, number().schema,
                   "Dead time of the plant less that of the disturbance: above 0 no compensator is exact.",
                   {.unit = "time"})
            .field("peak_bound", {}, [](const A& a, Writer& out) { out.number(a.result.peak_bound); }, number().schema,
                   "Magnitude of the error that no feedforward avoids.", {.unit = "y"});
        add_answer_members(d);
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
