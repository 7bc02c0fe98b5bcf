#include "api/contract/controller.h"
#include "api/contract/product/product.h"
#include "api/contract/product/value.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxWord = 200;

Codec<std::optional<std::vector<double>>> span() { return maybe(numbers(2, 2)); }

void check_span(const char* name, const std::optional<std::vector<double>>& given, Reader& reader) {
    if (given && !((*given)[0] < (*given)[1]))
        reader.fault_at(name, std::string(name) + " is [" + full_digits((*given)[0]) + ", " + full_digits((*given)[1]) +
                                  "]; its first number must be below the second.");
}

void set_context(const Json&, BlockContext& request, Reader& reader) {
    check_span("y_span", request.y_span, reader);
    check_span("u_span", request.u_span, reader);
    const std::string unit = request.units.value_or(Units{}).time_or_default();
    const auto seconds = seconds_per(unit);
    if (!seconds) {
        const Reader::At at(reader, "units");
        reader.fault_at("time", "units.time is " + shown(unit) +
                                    ", which is no unit of time that is known; the block's times are in its own. Use "
                                    "s, min, h or another.");
        return;
    }
    product::Context& context = request.context;
    context.seconds_per_time = *seconds;
    context.y_span_given = request.y_span.has_value();
    context.u_span_given = request.u_span.has_value();
    if (request.y_span) context.spans.y_low = (*request.y_span)[0], context.spans.y_high = (*request.y_span)[1];
    if (request.u_span) context.spans.u_low = (*request.u_span)[0], context.spans.u_high = (*request.u_span)[1];
    if (request.sample_time) context.sample_time_s = *request.sample_time * *seconds;
}

template <class Request>
void add_context(Description<Request>& d) {
    d.field("y_span", &Request::y_span, span(), "Range of the measurement, low and high end; for gains in percent.",
            {.unit = "y"})
        .field("u_span", &Request::u_span, span(), "Range of the output, low and high end.", {.unit = "u"})
        .field("sample_time", &Request::sample_time, maybe(number({.exclusive_minimum = 0})),
               "Period with which the block runs; for parameters and filters that count it.", {.unit = "time"})
        .field("units", &Request::units, maybe(object(units_contract())),
               "Labels; time is also the unit of the controller's times, s if not given.")
        .check([](const Json& json, Request& request, Reader& reader) { set_context(json, request, reader); });
}

void read_settings(const Json& value, TwinRequest& request, Reader& reader) {
    if (!value.is_object()) return reader.fault(wrong_kind(value, "an object such as {\"Gain\": 1.5}", reader));
    for (const auto& [name, member] : value.items()) {
        const Reader::At at(reader, name);
        if (member.is_number()) {
            if (const auto number = read_number(member, {}, reader)) request.settings.push_back({name, *number});
        } else if (member.is_boolean()) {
            request.settings.push_back({name, member.get<bool>()});
        } else if (member.is_string() && member.get_ref<const std::string&>().size() <= kMaxWord) {
            request.settings.push_back({name, member.get<std::string>()});
        } else {
            reader.fault(wrong_kind(member, "a number, a short string, true or false", reader));
        }
    }
}

Json notes_schema(SchemaBook&) {
    return {{"type", "array"},
            {"items",
             {{"type", "object"},
              {"properties",
               {{"code", {{"type", "string"}, {"description", "For programs, kebab-case."}}},
                {"detail", {{"type", "string"}, {"description", "A sentence with the figures."}}}}},
              {"required", {"code", "detail"}},
              {"additionalProperties", false}}}};
}

void write_notes(const std::vector<product::Note>& notes, Writer& out) {
    out.begin_array();
    for (const product::Note& note : notes) {
        out.begin_object();
        out.key("code");
        out.text(note.code);
        out.key("detail");
        out.text(note.detail);
        out.end_object();
    }
    out.end_array();
}

// A text for each setting that has one.
template <class Text>
void write_texts(const SettingsAnswer& answer, const Text& text, Writer& out) {
    out.begin_object();
    for (const product::Setting& setting : answer.converted.settings) {
        const std::string words = text(setting);
        if (words.empty()) continue;
        out.key(setting.name);
        out.text(words);
    }
    out.end_object();
}

Json texts_by_name(SchemaBook&) { return {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}; }

Json controller_schema(SchemaBook& book) { return controller_contract().schema(book); }

}  // namespace

const Description<SettingsRequest>& settings_request_contract() {
    static const auto contract = [] {
        Description<SettingsRequest> d("SettingsRequest", "A controller that is to be typed into a product.");
        d.field("controller", &SettingsRequest::controller, maybe(one_of(controller_contract())), "The controller.",
                {.required = true})
            .field("nearest", &SettingsRequest::nearest, boolean(),
                   "Answer the nearest settings where the product cannot be this controller, instead of 422.");
        add_context(d);
        d.example({{"controller",
                    {{"form", "ideal"},
                     {"Kp", 1.5},
                     {"Ti", 120},
                     {"Td", 20},
                     {"b", 0.6},
                     {"filter", {{"type", "derivative"}, {"Tf", 2}}}}},
                   {"y_span", {0, 200}},
                   {"u_span", {0, 100}},
                   {"sample_time", 0.25}});
        return d;
    }();
    return contract;
}

const Description<SettingsAnswer>& settings_answer_contract() {
    static const auto contract = [] {
        using Answer = SettingsAnswer;
        Description<Answer> d("SettingsAnswer", "What is to be typed, and what the product then does.");
        d.field(
             "settings", {}, [](const Answer& a, Writer& out) { write_settings(a.converted.settings, out); },
             [](SchemaBook&) { return settings_schema(); }, "In full precision.")
            .field(
                "units", {},
                [](const Answer& a, Writer& out) {
                    const auto unit = [&](const product::Setting& setting) {
                        const product::Parameter* parameter = product::parameter_named(*a.product, setting.name);
                        return std::string(parameter ? parameter->unit : "");
                    };
                    write_texts(a, unit, out);
                },
                texts_by_name, "Of the settings that have one.")
            .field(
                "as_typed", {},
                [](const Answer& a, Writer& out) {
                    write_texts(
                        a, [&](const product::Setting& setting) { return product::typed_text(*a.product, setting); },
                        out);
                },
                texts_by_name, "As a person types them, in the product's resolution.")
            .field(
                "realised", {},
                [](const Answer& a, Writer& out) {
                    controller_contract().write(Controller(a.converted.realised), out);
                },
                controller_schema,
                "What the product then does, weights and filter included; whole numbers as they are rounded.")
            .field(
                "notes", {}, [](const Answer& a, Writer& out) { write_notes(a.converted.notes, out); }, notes_schema,
                "What it does differently, and what of it is not verified.");
        return d;
    }();
    return contract;
}

const Description<TwinRequest>& twin_request_contract() {
    static const auto contract = [] {
        Description<TwinRequest> d("ProductSettings", "Settings of a product.");
        d.field(
            "settings", read_settings,
            [](const TwinRequest& request, Writer& out) { write_settings(request.settings, out); },
            [](SchemaBook&) { return settings_schema(); },
            "Values by the names of the parameters. What is missing has the maker's default, or is not there.",
            {.required = true});
        add_context(d);
        d.example({{"settings", {{"GAIN", 2.32793}, {"RESET", 93.1174}, {"RATE", 30.723}, {"ALPHA", 0.125}}},
                   {"y_span", {0, 200}},
                   {"u_span", {0, 100}}});
        return d;
    }();
    return contract;
}

const Description<TwinAnswer>& twin_answer_contract() {
    static const auto contract = [] {
        Description<TwinAnswer> d("ProductController", "The controller that settings of a product are.");
        d.field(
             "controller", {},
             [](const TwinAnswer& answer, Writer& out) {
                 controller_contract().write(Controller(answer.controller), out);
             },
             controller_schema, "Its exact twin in the ideal form.")
            .field(
                "notes", {}, [](const TwinAnswer& answer, Writer& out) { write_notes(answer.notes, out); },
                notes_schema, "What was assumed.");
        return d;
    }();
    return contract;
}

}  // namespace tunewright::api
