#include "api/contract/product/conversion.h"

#include "api/contract/controller.h"

namespace tunewright::api {
namespace {

Codec<std::optional<std::vector<double>>> span() { return maybe(numbers(2, 2)); }

void set_context(const Json&, BlockContext& request, Reader& reader) {
    check_span("y_span", request.y_span, reader);
    check_span("u_span", request.u_span, reader);
    const auto seconds = seconds_per_time(request.units.value_or(Units{}).time_or_default(), reader);
    if (!seconds) return;
    request.context = context_of(request.y_span, request.u_span, *seconds);
    if (request.sample_time) request.context.sample_time_s = *request.sample_time * *seconds;
}

template <class Request>
void add_context(Description<Request>& d) {
    d.field("y_span", &Request::y_span, span(), "Range of the measurement, low and high end; for gains in percent.",
            {.unit = "y"})
        .field("u_span", &Request::u_span, span(), "Range of the output, low and high end.", {.unit = "u"})
        .field("sample_time", &Request::sample_time, maybe(number({.exclusive_minimum = 0})),
               "Period of the block; for parameters and filters that depend on it.", {.unit = "time"})
        .field("units", &Request::units, maybe(object(units_contract())),
               "Labels; time is also the unit of the controller's times, s if not given.")
        .check([](const Json& json, Request& request, Reader& reader) { set_context(json, request, reader); });
}

const Description<product::Note>& note_contract() {
    static const auto contract = [] {
        using N = product::Note;
        Description<N> d("SettingsNote", "A remark about settings of a product.");
        d.field("code", &N::code, words(), "Code for programs, kebab-case.")
            .field("detail", &N::detail, words(), "A sentence with the figures.")
            .field(
                "deviation", {}, [](const N& note, Writer& out) { out.boolean(product::is_deviation(note)); },
                boolean().schema,
                "true: a part of the design that the product cannot do, or something to be done beside it. false: how "
                "the settings were computed.");
        return d;
    }();
    return contract;
}

Codec<std::vector<product::Note>> notes() { return list_of(answer(note_contract())); }

const Description<product::FilledSnippet>& snippet_contract() {
    static const auto contract = [] {
        using S = product::FilledSnippet;
        Description<S> d("Snippet", "Text to paste into a program or file.");
        d.field(
             "name", {}, [](const S& one, Writer& out) { out.text(one.name); }, words().schema,
             "Language or file, and the place in it.")
            .field("text", &S::text, words(), "Lines to paste.");
        return d;
    }();
    return contract;
}

Json texts_by_name(SchemaBook&) { return {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}; }

Json controller_schema(SchemaBook& book) { return controller_contract().schema(book); }

}  // namespace

Codec<std::vector<product::FilledSnippet>> snippets() { return list_of(answer(snippet_contract())); }

const Description<SettingsRequest>& settings_request_contract() {
    static const auto contract = [] {
        Description<SettingsRequest> d("SettingsRequest", "A controller that is to be typed into a product.");
        d.field("controller", &SettingsRequest::controller, maybe(one_of(controller_contract())), "The controller.",
                {.required = true})
            .field("nearest", &SettingsRequest::nearest, boolean(),
                   "Return the nearest settings instead of 422 if the product cannot represent this controller.");
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
        Description<Answer> d("SettingsAnswer", "The settings to type, and the behaviour of the product with them.");
        d.field(
             "product", {}, [](const Answer& a, Writer& out) { out.text(a.product->id); }, words().schema,
             "Id of the product.")
            .field("settings", &Answer::settings, only_answered(settings_codec()), "In full precision.")
            .field(
                "units", {},
                [](const Answer& a, Writer& out) {
                    out.begin_object();
                    for (const product::Setting& setting : a.settings) {
                        const product::Parameter* parameter = product::parameter_named(*a.product, setting.name);
                        if (parameter == nullptr || parameter->unit.empty()) continue;
                        out.key(setting.name).text(std::string(parameter->unit));
                    }
                    out.end_object();
                },
                texts_by_name, "Units of the settings that have one.")
            .field(
                "as_typed", {},
                [](const Answer& a, Writer& out) {
                    out.begin_object();
                    for (const product::Setting& setting : a.typed)
                        out.key(setting.name).text(product::typed_text(*a.product, setting));
                    out.end_object();
                },
                texts_by_name, "As typed, in the product's resolution.")
            .field(
                "snippets", {},
                [](const Answer& a, Writer& out) {
                    snippets().write(product::filled_snippets(*a.product, a.typed, a.context), out);
                },
                snippets().schema,
                "Text to paste into the user's program or file, with the settings as typed. Left out if the product "
                "is not set by text.",
                {}, [](const Answer& a) { return a.product->snippets.empty(); })
            .field(
                "realised", {},
                [](const Answer& a, Writer& out) { controller_contract().write(Controller(a.realised), out); },
                controller_schema,
                "The controller that the product then represents, with weights and filter; after rounding.")
            .field("notes", &Answer::notes, notes(), "Deviations from the controller, and facts that are not verified.")
            .field(
                "standard_errors", &Answer::standard_errors,
                unless<std::map<std::string, double>>(numbers_by_name("The parameter's name."),
                                                      [](const auto& errors) { return errors.empty(); }),
                "Of settings from a record: one standard deviation of each number that gain and times of the law set, "
                "in the parameter's unit.");
        return d;
    }();
    return contract;
}

const Description<ScheduleSettingsRequest>& schedule_settings_request_contract() {
    static const auto contract = [] {
        using R = ScheduleSettingsRequest;
        Description<R> d("ScheduleSettingsRequest", "The rows of a schedule to type into a product.");
        d.field("rows", &R::rows, list_of(object(given_row_contract()), 1, range::kMaxRows),
                "In the form of range.schedule.rows of a result.", {.required = true})
            .field("interpolation", &R::interpolation, interpolation_word(), "Interpolation between the rows.")
            .field("nearest", &R::nearest, boolean(),
                   "Return the nearest settings instead of 422 if the product cannot represent a row.")
            .check([](const Json&, R& request, Reader& reader) {
                const Reader::At list(reader, "rows");
                check_given_rows(request.rows, reader);
            });
        add_context(d);
        d.example(
            {{"rows",
              {{{"at", 20}, {"Kp", 3}, {"Ti", 90}, {"Td", 15}}, {{"at", 60}, {"Kp", 1.5}, {"Ti", 120}, {"Td", 20}}}},
             {"interpolation", "steps"},
             {"y_span", {0, 200}},
             {"u_span", {0, 100}},
             {"sample_time", 0.25}});
        return d;
    }();
    return contract;
}

namespace {

struct AnsweredRow {
    double at = 0;
    SettingsAnswer answer;
};

const Description<AnsweredRow>& answered_row_contract() {
    static const auto contract = [] {
        Description<AnsweredRow> d("SettingsRow", "The settings to type at one place, as for one controller.");
        d.field("at", &AnsweredRow::at, only_answered(number()), "Its place.")
            .field(
                "typing", {},
                [](const AnsweredRow& row, Writer& out) { settings_answer_contract().write(row.answer, out); },
                [](SchemaBook& book) { return settings_answer_contract().schema(book); },
                "The settings of the row; the notes are only those of this row.");
        return d;
    }();
    return contract;
}

}  // namespace

const Description<ScheduleSettingsAnswer>& schedule_settings_answer_contract() {
    static const auto contract = [] {
        using Answer = ScheduleSettingsAnswer;
        Description<Answer> d("ScheduleSettingsAnswer", "The settings to type for each row of a schedule.");
        d.field(
             "rows", {},
             [](const Answer& a, Writer& out) {
                 out.begin_array();
                 for (const product::RowSettings& row : a.schedule.rows)
                     answered_row_contract().write({row.at,
                                                    {a.product,
                                                     row.converted.settings,
                                                     row.converted.settings,
                                                     row.converted.realised,
                                                     row.converted.notes,
                                                     {}}},
                                                   out);
                 out.end_array();
             },
             [](SchemaBook& book) {
                 return Json{{"type", "array"}, {"items", answered_row_contract().schema(book)}};
             },
             "Ascending in `at`.")
            .field(
                "notes", {}, [](const Answer& a, Writer& out) { notes().write(a.schedule.notes, out); }, notes().schema,
                "The product's interpolation between the rows, and notes that apply to all of them.");
        return d;
    }();
    return contract;
}

const Description<TwinRequest>& twin_request_contract() {
    static const auto contract = [] {
        Description<TwinRequest> d("ProductSettings", "Settings of a product.");
        d.field("settings", &TwinRequest::settings, settings_codec(),
                "Values by the names of the parameters. A missing one has the maker's default, or is unused.",
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
        Description<TwinAnswer> d("ProductController", "The controller that settings of a product represent.");
        d.field(
             "controller", {},
             [](const TwinAnswer& answer, Writer& out) {
                 controller_contract().write(Controller(answer.controller), out);
             },
             controller_schema, "The equivalent controller in the ideal form.")
            .field("notes", &TwinAnswer::notes, notes(), "Assumptions.");
        return d;
    }();
    return contract;
}

}  // namespace tunewright::api
