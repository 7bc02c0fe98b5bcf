#include "api/contract/built/built.h"

#include "api/contract/result/evaluation.h"

namespace tunewright::api {
namespace {

const Description<AsBuilt>& difference_contract() {
    static const auto description = [] {
        Description<AsBuilt> d("Difference", "How far the loop as built lies above the entry's ideal one.");
        d.field("Ms_percent", &AsBuilt::Ms_percent, figure(), "Of Ms.", {.unit = "%"})
            .field("load_IAE_percent", &AsBuilt::load_IAE_percent, figure(), "Of the load IAE.", {.unit = "%"})
            .field("overshoot_points", &AsBuilt::overshoot_points, figure(),
                   "Of the overshoot of a set-point step, in percent of the step.", {.unit = "%"})
            .field("differs", &AsBuilt::differs,
                   only_answered(list_of(choice<DifferingFigure>({{"Ms", DifferingFigure::Ms},
                                                                  {"load_IAE", DifferingFigure::load_IAE},
                                                                  {"overshoot", DifferingFigure::overshoot}}))),
                   "The figures that lie more than 2 % off: for them it is another loop. Empty for an unstable loop.")
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
        codec.skip ? Callable<bool(const AsBuilt&)>(
                         [member, codec](const AsBuilt& built) { return codec.skip(built.loop.*member); })
                   : Callable<bool(const AsBuilt&)>());
}

}  // namespace

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
