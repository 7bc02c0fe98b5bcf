#include "api/contract/built/as_built.h"

#include "api/contract/built/settings.h"
#include "api/contract/controller.h"
#include "api/contract/result/evaluation.h"

namespace tunewright::api {
namespace {

Json texts_schema(SchemaBook&) { return Json{{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}; }

const Description<product::Note>& note_contract() {
    static const auto description = [] {
        Description<product::Note> d("Note", "A remark on a conversion.");
        d.field("code", &product::Note::code, words(), "For programs.")
            .field("detail", &product::Note::detail, words(), "A sentence.");
        return d;
    }();
    return description;
}

const Description<AsBuilt>& difference_contract() {
    static const auto description = [] {
        Description<AsBuilt> d("Difference", "How far the loop as built lies above the entry's ideal one.");
        d.field("Ms_percent", &AsBuilt::Ms_percent, figure(), "Of Ms.", {.unit = "%"})
            .field("load_IAE_percent", &AsBuilt::load_IAE_percent, figure(), "Of the load IAE.", {.unit = "%"})
            .why_null("Not known for this loop.");
        return d;
    }();
    return description;
}

// A member of the loop, which the answer has side by side with its difference.
template <class M>
void loop_field(Description<AsBuilt>& d, const char* name, M BuiltLoop::*member, const Codec<M>& codec,
                const char* sentence) {
    d.field(
        name, {}, [member, codec](const AsBuilt& built, Writer& out) { codec.write(built.loop.*member, out); },
        codec.schema, sentence, {},
        [member, codec](const AsBuilt& built) { return codec.skip && codec.skip(built.loop.*member); });
}

}  // namespace

const Description<built::Fitted>& as_entered_contract() {
    static const auto description = [] {
        using F = built::Fitted;
        Description<F> d("AsEntered", "What to type into the product, and what the product then does.");
        d.field("settings", &F::settings, only_answered(settings_codec()), "In full precision.")
            .field(
                "as_typed", {},
                [](const F& fitted, Writer& out) {
                    out.begin_object();
                    for (std::size_t i = 0; i < fitted.typed.size(); ++i) {
                        out.key(fitted.typed[i].name);
                        out.text(fitted.texts[i]);
                    }
                    out.end_object();
                },
                texts_schema, "As texts, in the product's resolution and range.")
            .field(
                "units", {},
                [](const F& fitted, Writer& out) {
                    out.begin_object();
                    for (const product::Setting& setting : fitted.typed) {
                        const auto* parameter = product::parameter_named(*fitted.product, setting.name);
                        if (parameter == nullptr || parameter->unit.empty()) continue;
                        out.key(setting.name);
                        out.text(std::string(parameter->unit));
                    }
                    out.end_object();
                },
                texts_schema, "Of those that have one.")
            .field(
                "realised", {},
                [](const F& fitted, Writer& out) { one_of(controller_contract()).write(fitted.controller, out); },
                [](SchemaBook& book) { return one_of(controller_contract()).schema(book); },
                "The exact ideal twin of what is typed, weights and filter included.")
            .field("notes", &F::notes, list_of(answer(note_contract())), "Where it deviates, and what to know.");
        return d;
    }();
    return description;
}

const Description<AsBuilt>& implemented_contract() {
    static const auto description = [] {
        Description<AsBuilt> d("Implemented",
                               "The loop with the settings as typed, computed as the controller computes: Ms, Mt and "
                               "the margins of its samples, indices and traces of the continuous y.");
        d.field(
            "sample_time", {},
            [](const AsBuilt& built, Writer& out) {
                built.fitted.law.Ts > 0 ? out.number(built.fitted.law.Ts) : out.null();
            },
            [](SchemaBook&) {
                return Json{{"type", {"number", "null"}}};
            },
            "Period of the controller; null: it counts as continuous.", {.unit = "time"});
        loop_field(d, "robustness", &BuiltLoop::robustness, object(robustness_contract()), "Peaks and margins.");
        loop_field(d, "performance", &BuiltLoop::performance, object(performance_contract()),
                   "Figures of the responses.");
        loop_field(d, "responses", &BuiltLoop::responses, maybe(answer(responses_contract())),
                   "Traces over time; left out with points 0 and for unstable loops.");
        d.field(
            "difference", {}, [](const AsBuilt& built, Writer& out) { difference_contract().write(built, out); },
            [](SchemaBook& book) { return difference_contract().schema(book); }, "From the ideal loop of this entry.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
