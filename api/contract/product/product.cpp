#include "api/contract/product/product.h"

#include <cmath>

#include "api/contract/controller.h"
#include "api/contract/range/range_request.h"
#include "api/csv/time_stamp.h"
#include "engine/controller/product/needs.h"

namespace tunewright::api {
namespace {

using product::Parameter;
using product::Product;
using Texts = std::vector<std::string_view>;

Json text_schema(SchemaBook&) { return Json{{"type", "string"}}; }
Json texts_schema(SchemaBook&) { return Json{{"type", "array"}, {"items", {{"type", "string"}}}}; }
Json maybe_number_schema(SchemaBook&) { return Json{{"type", {"number", "null"}}}; }
Json flag_schema(SchemaBook&) { return Json{{"type", "boolean"}}; }

template <class List>
void write_texts(const List& texts, Writer& out) {
    out.begin_array();
    for (const auto& text : texts) out.text(text);
    out.end_array();
}

/// The codec of members that only answers have, from any part of T.
template <class T>
class AnswerDescription {
public:
    AnswerDescription(std::string name, std::string sentence) : description(std::move(name), std::move(sentence)) {}

    template <class Get>
    AnswerDescription& text(std::string name, Get get, std::string sentence) {
        description.field(
            std::move(name), {}, [get](const T& value, Writer& out) { out.text(get(value)); }, text_schema,
            std::move(sentence));
        return *this;
    }
    /// Left out if it is empty.
    template <class Get>
    AnswerDescription& maybe_text(std::string name, Get get, std::string sentence) {
        description.field(
            std::move(name), {}, [get](const T& value, Writer& out) { out.text(get(value)); }, text_schema,
            std::move(sentence), {}, [get](const T& value) { return get(value).empty(); });
        return *this;
    }
    template <class Get>
    AnswerDescription& texts(std::string name, Get get, std::string sentence) {
        description.field(
            std::move(name), {}, [get](const T& value, Writer& out) { write_texts(get(value), out); }, texts_schema,
            std::move(sentence));
        return *this;
    }
    /// null if there is none.
    template <class Get>
    AnswerDescription& number(std::string name, Get get, std::string sentence, std::string unit = "") {
        description.field(std::move(name), {},
                          [get](const T& value, Writer& out) {
                              const std::optional<double> number = get(value);
                              number ? out.number(*number) : out.null();
                          },
                          maybe_number_schema, std::move(sentence), {.unit = unit});
        return *this;
    }
    template <class Get>
    AnswerDescription& flag(std::string name, Get get, std::string sentence) {
        description.field(
            std::move(name), {}, [get](const T& value, Writer& out) { out.boolean(get(value)); }, flag_schema,
            std::move(sentence));
        return *this;
    }
    template <class Part, class Get>
    AnswerDescription& part(std::string name, const Description<Part>& inner, Get get, std::string sentence) {
        const Description<Part>* what = &inner;
        description.field(
            std::move(name), {}, [what, get](const T& value, Writer& out) { what->write(get(value), out); },
            [what](SchemaBook& book) { return what->schema(book); }, std::move(sentence));
        return *this;
    }

    Description<T> description;
};

std::optional<double> finite(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

void write_choices(const Parameter& parameter, Writer& out) {
    out.begin_array();
    for (const product::Option& option : parameter.options) {
        out.begin_object();
        out.key("value");
        write_value(option.value, out);
        for (const auto& [name, weight] : {std::pair{"b", option.b}, {"c", option.c}}) {
            if (!weight) continue;
            out.key(name).number(*weight);
        }
        out.end_object();
    }
    out.end_array();
}

Json choices_schema(SchemaBook&) {
    return {{"type", "array"},
            {"items",
             {{"type", "object"},
              {"properties", {{"value", value_schema()}, {"b", {{"type", "number"}}}, {"c", {{"type", "number"}}}}},
              {"required", {"value"}},
              {"additionalProperties", false}}}};
}

/// A row for writing: a parameter with the data of its product.
struct Row {
    const Product* product = nullptr;
    const Parameter* parameter = nullptr;
};

const Description<Row>& parameter_contract() {
    static const auto contract = [] {
        AnswerDescription<Row> a("ControllerParameter", "A parameter of a product.");
        a.text(
             "name", [](const Row& row) { return row.parameter->name; }, "The name in settings.")
            .text(
                "label", [](const Row& row) { return row.parameter->label; }, "As in the maker's software or manual.")
            .text(
                "unit", [](const Row& row) { return row.parameter->unit; }, "Unit, \"\" for none.")
            .text(
                "role", [](const Row& row) { return product::to_string(row.parameter->role); },
                "gain, multiplier, integral, derivative, filter, weight_b, weight_c, choice, sample_time, fixed or "
                "limit.")
            .text(
                "formula", [](const Row& row) { return product::formula_text(*row.product, *row.parameter); },
                "Formula in the quantities of the law: Kp, Ti, Td, Tf in seconds; Kc, ti, td of the series form; Sy, "
                "Su the spans, Ts the "
                "sample time, dt the firmware's clock.")
            .number(
                "low", [](const Row& row) { return finite(row.parameter->range.low); }, "Smallest value; null: none.")
            .number(
                "high", [](const Row& row) { return finite(row.parameter->range.high); }, "Largest value; null: none.")
            .number(
                "resolution",
                [](const Row& row) {
                    const double step = row.parameter->resolution;
                    return step > 0 ? std::optional(step) : std::nullopt;
                },
                "Step of the values that can be typed; null: a floating-point number.")
            .number(
                "off", [](const Row& row) { return row.parameter->off; }, "The value that switches this part off.")
            .flag(
                "written",
                [](const Row& row) {
                    return (!row.parameter->elsewhere || !row.parameter->options.empty()) &&
                           !product::depends_on_choice(*row.product, *row.parameter);
                },
                "false: it is in the settings only with the choice that uses it, or it is determined elsewhere.")
            .maybe_text(
                "remark", [](const Row& row) { return row.parameter->remark; }, "Further remarks.");
        a.description
            .field(
                "default", {}, [](const Row& row, Writer& out) { write_value(*row.parameter->standard, out); },
                [](SchemaBook&) { return value_schema(); }, "The maker's default, if it is known.", {},
                [](const Row& row) { return !row.parameter->standard; })
            .field(
                "choices", {}, [](const Row& row, Writer& out) { write_choices(*row.parameter, out); }, choices_schema,
                "Allowed values, the default first, with the set-point weights that each implies.", {},
                [](const Row& row) { return row.parameter->options.empty(); });
        return std::move(a.description);
    }();
    return contract;
}

const char* sign_word(const Product& product) {
    switch (product.action.kind) {
        case product::Action::Kind::signed_gain: return "gain";
        case product::Action::Kind::switched: return "switch";
        case product::Action::Kind::reverse_only: return "reverse only";
    }
    return "gain";
}

const char* rule_word(IntegralRule rule) {
    switch (rule) {
        case IntegralRule::backward: return "backward";
        case IntegralRule::forward: return "forward";
        case IntegralRule::trapezoidal: return "trapezoidal";
    }
    return "backward";
}

const char* rule_word(DerivativeRule rule) {
    switch (rule) {
        case DerivativeRule::difference: return "difference";
        case DerivativeRule::filtered_backward: return "filtered, backward";
        case DerivativeRule::filtered_forward: return "filtered, forward";
        case DerivativeRule::filtered_trapezoidal: return "filtered, trapezoidal";
        case DerivativeRule::slope: return "slope";
        case DerivativeRule::four_points: return "four points";
    }
    return "difference";
}

const Description<product::Weights>& weights_contract() {
    static const auto contract = [] {
        AnswerDescription<product::Weights> a("ControllerWeights", "Set-point weights that no parameter sets.");
        a.number(
             "b", [](const product::Weights& w) { return std::optional(w.b); }, "Weight of the proportional part.")
            .number(
                "c", [](const product::Weights& w) { return std::optional(w.c); }, "Weight of the derivative part.")
            .maybe_text(
                "text", [](const product::Weights& w) { return w.text; }, "In words.");
        return std::move(a.description);
    }();
    return contract;
}

const Description<Product>& action_contract() {
    static const auto contract = [] {
        AnswerDescription<Product> a("ControllerAction", "Notation of the sign of Kp.");
        a.text("by", sign_word, "gain: the sign of the gain; switch: a parameter; reverse only: no direct action.")
            .maybe_text(
                "name", [](const Product& p) { return p.action.name; }, "The switch's name in settings.")
            .maybe_text(
                "text", [](const Product& p) { return p.action.text; }, "In words.");
        a.description.field(
            "direct", {}, [](const Product& p, Writer& out) { write_value(p.action.direct, out); },
            [](SchemaBook&) { return value_schema(); }, "The switch's value for a negative Kp.", {},
            [](const Product& p) { return p.action.kind != product::Action::Kind::switched; });
        return std::move(a.description);
    }();
    return contract;
}

const Description<product::Algorithm>& algorithm_contract() {
    static const auto contract = [] {
        using product::Algorithm;
        AnswerDescription<Algorithm> a("ControllerAlgorithm", "Algorithm of the law.");
        a.text(
             "integral", [](const Algorithm& x) { return rule_word(x.integral); }, "Rule of the integral.")
            .text(
                "derivative", [](const Algorithm& x) { return rule_word(x.derivative); }, "Rule of the derivative.")
            .text(
                "form", [](const Algorithm& x) { return x.velocity ? "velocity" : "position"; },
                "position or velocity.")
            .flag(
                "published", [](const Algorithm& x) { return x.published; },
                "false: the rules are not documented and are therefore assumed.")
            .number(
                "sample_time", [](const Algorithm& x) { return x.sample_time_s; }, "Default; null: none.", "s")
            .flag(
                "clock_fixed", [](const Algorithm& x) { return x.firmware_clock; },
                "The firmware fixes this sample time, and formulas use it.")
            .maybe_text(
                "sample_time_text", [](const Algorithm& x) { return x.sample_time_text; }, "Source of the sample time.")
            .maybe_text(
                "anti_windup", [](const Algorithm& x) { return x.anti_windup; }, "Behaviour at limits.")
            .maybe_text(
                "text", [](const Algorithm& x) { return x.text; }, "In words.");
        return std::move(a.description);
    }();
    return contract;
}

const Description<product::Evidence>& evidence_contract() {
    static const auto contract = [] {
        using product::Evidence;
        AnswerDescription<Evidence> a("ControllerEvidence", "Facts that were read, and their sources.");
        a.text(
             "level", [](const Evidence& e) { return product::to_string(e.level); },
             "read: form, parameters and units were read in code or the maker's text; partly: in texts of third "
             "parties, or not completely; unverified: no document was available.")
            .texts(
                "read", [](const Evidence& e) -> const Texts& { return e.read; }, "Facts that were read.")
            .texts(
                "unverified", [](const Evidence& e) -> const Texts& { return e.unverified; },
                "Facts that were not read.")
            .texts(
                "sources", [](const Evidence& e) -> const Texts& { return e.sources; }, "Sources.");
        return std::move(a.description);
    }();
    return contract;
}

const Description<product::Example>& example_contract() {
    static const auto contract = [] {
        using product::Example;
        AnswerDescription<Example> a("ControllerExample", "A design and its settings as typed, to six digits.");
        a.number(
            "sample_time", [](const Example& e) { return std::optional(e.sample_time_s); }, "Sample time.", "s");
        const auto span = [](double Example::*member) {
            return [member](const Example& e, Writer& out) { out.numbers(std::vector{0.0, e.*member}); };
        };
        const auto span_schema = [](SchemaBook&) { return Json{{"type", "array"}, {"items", {{"type", "number"}}}}; };
        a.description
            .field(
                "controller", {},
                [](const Example& e, Writer& out) { controller_contract().write(Controller(e.design), out); },
                [](SchemaBook& book) { return controller_contract().schema(book); }, "The design; times in s.")
            .field("y_span", {}, span(&Example::y_span), span_schema, "Range of the measurement.")
            .field("u_span", {}, span(&Example::u_span), span_schema, "Range of the output.")
            .field(
                "settings", {}, [](const Example& e, Writer& out) { settings_codec().write(e.settings, out); },
                settings_codec().schema, "The settings as typed.");
        return std::move(a.description);
    }();
    return contract;
}

void add_head(AnswerDescription<Product>& a) {
    a.text(
         "id", [](const Product& p) { return p.id; }, "The name in requests.")
        .text(
            "maker", [](const Product& p) { return p.maker; }, "The maker.")
        .text(
            "name", [](const Product& p) { return p.name; }, "The block, library or firmware.")
        .texts(
            "families", [](const Product& p) { return p.families; }, "Other names under which users know it.")
        .text(
            "form", [](const Product& p) { return product::to_string(p.form); }, "ideal, parallel, series or p_only.")
        .texts(
            "needs", [](const Product& p) { return product::needs_of(p); },
            "Those of y_span, u_span and sample_time that its conversions need.");
}

void write_parameters(const Product& p, Writer& out) {
    out.begin_array();
    for (const Parameter& parameter : p.parameters) parameter_contract().write({&p, &parameter}, out);
    out.end_array();
}

}  // namespace

const Description<Product>& product_summary_contract() {
    static const auto contract = [] {
        AnswerDescription<Product> a("ControllerSummary", "A product, in short.");
        add_head(a);
        a.text(
             "evidence", [](const Product& p) { return product::to_string(p.evidence.level); },
             "read, partly or unverified.")
            .texts(
                "parameters",
                [](const Product& p) {
                    Texts names;
                    for (const Parameter& parameter : p.parameters) names.push_back(parameter.name);
                    return names;
                },
                "The names of its parameters.");
        return std::move(a.description);
    }();
    return contract;
}

const Description<Product>& product_contract() {
    static const auto contract = [] {
        AnswerDescription<Product> a("ControllerProduct", "A product.");
        add_head(a);
        a.text(
             "law", [](const Product& p) { return p.law; }, "Its law in the parameters' names.")
            .text(
                "gain_basis", [](const Product& p) { return p.gain_basis; }, "Units of its gain.");
        a.description.field(
            "parameters", {}, write_parameters,
            [](SchemaBook& book) {
                return Json{{"type", "array"}, {"items", parameter_contract().schema(book)}};
            },
            "Its parameters.");
        a.maybe_text(
             "filter", [](const Product& p) { return p.filter.text; }, "The filter.")
            .part(
                "setpoint_weights", weights_contract(),
                [](const Product& p) -> const product::Weights& { return p.weights; }, "Set-point weights.")
            .part(
                "action", action_contract(), [](const Product& p) -> const Product& { return p; }, "Direction.")
            .part(
                "algorithm", algorithm_contract(),
                [](const Product& p) -> const product::Algorithm& { return p.algorithm; }, "Algorithm.");
        a.description.field(
            "gain_scheduling", {},
            [](const Product& p, Writer& out) { gain_scheduling_contract().write(*p.scheduling, out); },
            [](SchemaBook& book) { return gain_scheduling_contract().schema(book); },
            "Its support of schedules; left out if none is known.", {}, [](const Product& p) { return !p.scheduling; });
        a.texts(
             "traps", [](const Product& p) -> const Texts& { return p.traps; }, "Common mistakes.")
            .part(
                "evidence", evidence_contract(),
                [](const Product& p) -> const product::Evidence& { return p.evidence; }, "Evidence.")
            .part(
                "example", example_contract(), [](const Product& p) -> const product::Example& { return p.example; },
                "Example.");
        return std::move(a.description);
    }();
    return contract;
}

namespace {

constexpr std::size_t kMaxSettings = 40;
constexpr std::size_t kMaxWord = 200;

void read_setting(const std::string& name, const Json& value, product::Settings& settings, Reader& reader) {
    const Reader::At at(reader, name);
    if (value.is_number()) {
        if (const auto number = read_number(value, {}, reader)) settings.push_back({name, *number});
    } else if (value.is_boolean()) {
        settings.push_back({name, value.get<bool>()});
    } else if (value.is_string() && value.get_ref<const std::string&>().size() <= kMaxWord) {
        settings.push_back({name, value.get<std::string>()});
    } else {
        reader.fault(wrong_kind(value, "a number, a short string, true or false", reader));
    }
}

}  // namespace

void write_value(const product::Value& value, Writer& out) {
    if (const double* number = std::get_if<double>(&value)) return out.number(*number);
    if (const bool* flag = std::get_if<bool>(&value)) return out.boolean(*flag);
    out.text(std::get<std::string>(value));
}

Json value_schema() { return {{"type", {"number", "string", "boolean"}}}; }

Codec<product::Settings> settings_codec() {
    Codec<product::Settings> codec;
    codec.read = [](const Json& value, product::Settings& settings, Reader& reader) {
        if (!value.is_object()) return reader.fault(wrong_kind(value, "an object such as {\"Gain\": 1.5}", reader));
        if (value.size() > kMaxSettings)
            return reader.fault("settings has " + std::to_string(value.size()) + " members, more than any product.");
        settings.clear();
        for (const auto& [name, member] : value.items()) read_setting(name, member, settings, reader);
    };
    codec.write = [](const product::Settings& settings, Writer& out) {
        out.begin_object();
        for (const product::Setting& setting : settings) {
            out.key(setting.name);
            write_value(setting.value, out);
        }
        out.end_object();
    };
    codec.schema = [](SchemaBook&) {
        return Json{{"type", "object"},
                    {"propertyNames", {{"description", "Names of the product's parameters."}}},
                    {"additionalProperties", value_schema()}};
    };
    return codec;
}

void check_span(const char* name, const std::optional<std::vector<double>>& given, Reader& reader) {
    if (given && !((*given)[0] < (*given)[1]))
        reader.fault_at(name, std::string(name) + " is [" + full_digits((*given)[0]) + ", " + full_digits((*given)[1]) +
                                  "]; its first number must be below the second.");
}

product::Context context_of(const std::optional<std::vector<double>>& y_span,
                            const std::optional<std::vector<double>>& u_span, double seconds_per_time) {
    product::Context context;
    context.seconds_per_time = seconds_per_time;
    context.y_span_given = y_span.has_value();
    context.u_span_given = u_span.has_value();
    product::Spans& spans = context.spans;
    if (y_span) spans.y_low = (*y_span)[0], spans.y_high = (*y_span)[1];
    if (u_span) spans.u_low = (*u_span)[0], spans.u_high = (*u_span)[1];
    return context;
}

std::optional<double> seconds_per_time(const std::string& label, Reader& reader) {
    const auto seconds = seconds_per(label);
    if (seconds) return seconds;
    const Reader::At at(reader, "units");
    reader.fault_at("time", "units.time is " + shown(label) +
                                ", which is not a known unit of time; the product's times have units of their own. Use "
                                "s, min, h or another.");
    return std::nullopt;
}

namespace {

Json text_of_scheduling(SchemaBook&) { return {{"type", "string"}}; }

}  // namespace

const Description<product::GainScheduling>& gain_scheduling_contract() {
    static const auto contract = [] {
        using Own = product::GainScheduling;
        Description<Own> d("GainScheduling",
                           "Support of a product for a table of settings over a scheduling variable.");
        d.field(
             "sets", {},
             [](const Own& own, Writer& out) { own.sets > 0 ? out.number(static_cast<double>(own.sets)) : out.null(); },
             [](SchemaBook&) {
                 return Json{{"type", {"integer", "null"}}};
             },
             "Maximum number of rows; null: no limit.")
            .field(
                "interpolation", {}, [](const Own& own, Writer& out) { interpolation_word().write(*own.between, out); },
                interpolation_word().schema, "The corresponding word of a schedule; left out if there is none.", {},
                [](const Own& own) { return !own.between; })
            .field(
                "detail", {}, [](const Own& own, Writer& out) { out.text(own.text); }, text_of_scheduling,
                "Its name, its scheduling variable, and its transition from one set to the next.")
            .field(
                "source", {}, [](const Own& own, Writer& out) { out.text(own.source); }, text_of_scheduling,
                "The source.");
        return d;
    }();
    return contract;
}

}  // namespace tunewright::api
