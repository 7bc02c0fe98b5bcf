// A text in place of a plant, and the call that parses it.
#include "api/contract/plant/typed.h"

#include "api/contract/plant/mathml.h"
#include "api/contract/product/conversion.h"
#include "api/contract/record.h"
#include "api/csv/time_stamp.h"
#include "engine/plant/typed/plant_snippets.h"
#include "engine/plant/typed/typed_plant.h"
#include "engine/plant/typed/words.h"

namespace tunewright::api {
namespace {

Json text_schema(SchemaBook& book) {
    Json schema{{"type", "string"}, {"title", "TypedPlant"}, {"maxLength", typed::kMaxLength}};
    schema["description"] =
        "A linear plant as typed: a formula in s, parameters by name, zeros and poles, or as MATLAB, Octave, "
        "python-control, ControlSystems.jl or Modelica write it. Numbers without a unit are in units.time.";
    schema["examples"] = {"2 e^(-3s)/((10s+1)(2s+1))",
                          "K=2 T=10 L=3",
                          "zeros -1, poles -2 -3±4i, gain 5",
                          "tf([2],[10 1],'InputDelay',3)",
                          "delay(3)*tf([2],[10,1])",
                          "Modelica.Blocks.Continuous.FirstOrder(k=2, T=10)",
                          "K=2 T=10 min L=30 s"};
    book.components["TypedPlant"] = std::move(schema);
    return {{"$ref", "#/components/schemas/TypedPlant"}};
}

/// The codec of a plant of any kind, or a text of a linear one.
template <class V>
Codec<V> or_text(const Codec<V>& inner) {
    return {[read = inner.read](const Json& value, V& target, Reader& reader) {
                if (!value.is_string()) return read(value, target, reader);
                if (auto typed = read_typed_plant(value.get_ref<const std::string&>(), reader))
                    target = std::move(typed->plant);
            },
            inner.write,
            [schema = inner.schema](SchemaBook& book) {
                return Json{{"oneOf", Json::array({schema(book), text_schema(book)})}};
            }};
}

}  // namespace

std::string as_sentence(std::string message) {
    if (!message.empty() && message[0] >= 'a' && message[0] <= 'z') message[0] = static_cast<char>(message[0] - 32);
    return message;
}

std::optional<TypedPlant> read_typed_plant(const std::string& text, Reader& reader) {
    auto typed = read_plant(text, seconds_per(reader.time_unit()).value_or(0));
    if (typed) return *std::move(typed);
    reader.fault(as_sentence(typed.error().message));
    return std::nullopt;
}

Codec<Plant> plant_or_text() { return or_text(one_of(plant_contract())); }

Codec<PlantModel> plant_model_or_text() { return or_text(one_of(plant_model_contract())); }

const Description<PlantQuestion>& plant_question_contract() {
    static const auto description = [] {
        Description<PlantQuestion> d("PlantQuestion", "A plant as typed, or one to be written as a formula.");
        d.field("units", &PlantQuestion::units, maybe(object(units_contract())),
                "Labels of the units; the plant's times are in units.time.")
            .field(
                "text",
                [](const Json& value, PlantQuestion& question, Reader& reader) {
                    if (!value.is_string())
                        return reader.fault(wrong_kind(value, "a text such as \"2 e^(-3s)/(10s+1)\"", reader));
                    if (auto typed = read_typed_plant(value.get_ref<const std::string&>(), reader)) {
                        question.plant = std::move(typed->plant);
                        question.formula = std::move(typed->formula);
                    }
                },
                {}, text_schema, "The text; exactly one of text and plant.")
            .field("plant", &PlantQuestion::plant, maybe(plant_or_text()),
                   "A linear plant; exactly one of text and plant.")
            .field("unfinished", &PlantQuestion::unfinished, boolean(),
                   "True while the text is being typed: a fault is then answered as `fault`, with status 200.")
            .check_presence([](const Json& value, PlantQuestion&, Reader& reader) {
                if (value.contains("text") == value.contains("plant"))
                    reader.fault("exactly one of text and plant is needed, such as {\"text\": \"2 e^(-3s)/(10s+1)\"}.");
            })
            .example({{"text", "2 e^(-3s)/((10s+1)(2s+1))"}});
        return d;
    }();
    return description;
}

const Description<PlantQuestion>& plant_answer_contract() {
    static const auto description = [] {
        const auto text_schema = [](SchemaBook&) { return Json{{"type", "string"}}; };
        const auto no_plant = [](const PlantQuestion& question) { return !question.plant; };
        Description<PlantQuestion> d("PlantAnswer", "A plant, its formula and its text; or its fault.");
        d.field("plant", &PlantQuestion::plant, maybe(only_answered(one_of(plant_contract()))), "The plant.")
            .field(
                "formula", {},
                [](const PlantQuestion& question, Writer& out) {
                    out.text(question.formula ? mathml(*question.formula) : mathml(*question.plant));
                },
                text_schema,
                "P(s) = ... as Presentation MathML, elements without attributes but for math itself; numbers with six "
                "significant digits.",
                {}, no_plant)
            .field(
                "text", {}, [](const PlantQuestion& question, Writer& out) { out.text(plant_text(*question.plant)); },
                text_schema,
                "The plant as typed, with all digits; empty for a state space that is too large for a line.", {},
                no_plant)
            .field(
                "snippets", {},
                [](const PlantQuestion& question, Writer& out) {
                    std::vector<product::FilledSnippet> texts;
                    const std::string unit = question.units.value_or(Units{}).time_or_default();
                    for (PlantSnippet& one : plant_snippets(*question.plant, unit))
                        texts.push_back({one.name, std::move(one.text)});
                    snippets().write(texts, out);
                },
                snippets().schema,
                "The plant for MATLAB, python-control, ControlSystems.jl and Modelica, with times in units.time; each "
                "can be sent as text in place of a plant. python-control has no dead time and gets a Pade "
                "approximation.",
                {}, no_plant)
            .field("fault", &PlantQuestion::fault, maybe(words()),
                   "Fault of an unfinished text; there are no other members then.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
