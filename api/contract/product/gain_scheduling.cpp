// What comes with a product for a table of settings.
#include "api/contract/product/product.h"

namespace tunewright::api {
namespace {

Json text_of_scheduling(SchemaBook&) { return {{"type", "string"}}; }

}  // namespace

const Description<product::GainScheduling>& gain_scheduling_contract() {
    static const auto contract = [] {
        using Own = product::GainScheduling;
        Description<Own> d("GainScheduling", "How a product takes a table of settings over a scheduling variable.");
        d.field(
             "sets", {},
             [](const Own& own, Writer& out) { own.sets > 0 ? out.number(static_cast<double>(own.sets)) : out.null(); },
             [](SchemaBook&) {
                 return Json{{"type", {"integer", "null"}}};
             },
             "Most rows that it holds; null: as many as wished.")
            .field(
                "interpolation", {}, [](const Own& own, Writer& out) { interpolation_word().write(*own.between, out); },
                interpolation_word().schema, "The word of a schedule for it; left out where none fits.", {},
                [](const Own& own) { return !own.between; })
            .field(
                "detail", {}, [](const Own& own, Writer& out) { out.text(own.text); }, text_of_scheduling,
                "Its name, what it is led by, and how it goes from one set to the next.")
            .field(
                "source", {}, [](const Own& own, Writer& out) { out.text(own.source); }, text_of_scheduling,
                "What was read.");
        return d;
    }();
    return contract;
}

}  // namespace tunewright::api
