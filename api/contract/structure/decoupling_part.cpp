#include "api/contract/structure/decoupling_part.h"

#include <cmath>

namespace tunewright::api {
namespace {

const Description<structure::Feedforward>& element_contract() {
    static const auto description = [] {
        using F = structure::Feedforward;
        Description<F> d("DecouplerElement", "Kf (Tz s + 1)/(Tp s + 1) e^(-Lf s).");
        d.field("Kf", &F::Kf, only_answered(number()), "Gain.")
            .field("Tz", &F::Tz, only_answered(number()), "Lead.", {.unit = "time"})
            .field("Tp", &F::Tp, only_answered(number()), "Lag.", {.unit = "time"})
            .field("Lf", &F::Lf, only_answered(number()), "Delay.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<structure::WrongGains>& wrong_gains_contract() {
    static const auto description = [] {
        using W = structure::WrongGains;
        Description<W> d("WrongGains", "The loops where the gain of any one path of the plant is wrong.");
        d.field("by", &W::by, only_answered(number()), "Share by which it is wrong, up or down.")
            .field("stable", &W::stable, only_answered(boolean()), "All loops together are stable in each case.")
            .field("mu", &W::mu, figure(), "The largest structured peak.")
            .why_null("In one case the loops are not stable together.");
        return d;
    }();
    return description;
}

template <class Item, class Write>
void write_rows(const std::vector<std::vector<Item>>& rows, Writer& out, const Write& write) {
    out.begin_array();
    for (const auto& row : rows) {
        out.begin_array();
        for (const Item& item : row) write(item);
        out.end_array();
    }
    out.end_array();
}

Json rows_schema(const Json& item) { return {{"type", "array"}, {"items", {{"type", "array"}, {"items", item}}}}; }

void write_elements(const DecouplingView& view, Writer& out) {
    write_rows(view.decoupler.elements, out,
               [&](const auto& element) { element ? element_contract().write(*element, out) : out.null(); });
}

}  // namespace

Codec<structure::DecouplerKind> decoupler_kind() {
    using enum structure::DecouplerKind;
    Words<structure::DecouplerKind> words;
    for (const auto kind : {none, static_gains, simplified}) words.emplace_back(name_of(kind), kind);
    return choice<structure::DecouplerKind>(words);
}

const Description<DecouplingView>& decoupling_contract() {
    static const auto description = [] {
        using D = DecouplingView;
        Description<D> d("Decoupling", "A decoupler: to the output of each controller it adds those of the others.");
        d.field(
             "kind", {}, [](const D& view, Writer& out) { out.text(name_of(view.decoupler.kind)); }, words().schema,
             "static: the gains at steady state; simplified: lead, lag and delay too.")
            .field(
                "D", {}, write_elements,
                [](SchemaBook& book) { return rows_schema(or_null(object(element_contract()).schema)(book)); },
                "Row: the loop to whose output is added; column: the loop whose output, as limits and manual have left "
                "it, is taken; null: nothing.")
            .field(
                "unrealised", {},
                [](const D& view, Writer& out) {
                    write_rows(view.decoupler.unrealised, out, [&](double time) { out.number(time); });
                },
                [](SchemaBook&) {
                    return rows_schema({{"type", "number"}});
                },
                "Time by which each element would have to act ahead; that is left out, and the rest interacts.",
                {.unit = "time"})
            .field("gain", &D::gain, figure(), "Cost without the decoupler over cost with it, at the same limit.")
            .field("wrong_gains", &D::wrong, answer(wrong_gains_contract()),
                   "The decoupler stays as it is while the plant differs.")
            .why_null("The loops are not stable together.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
