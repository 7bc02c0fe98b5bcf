// Settings to enter: today's settings and the new ones, by the names of the user's own controller if it is known, and
// the generic forms.
#include <algorithm>
#include <array>
#include <tuple>

#include "api/report/figures.h"
#include "api/report/sections.h"
#include "engine/controller/product/catalogue.h"

namespace tunewright::api {
namespace {

/// Members of a controller in the order in which they are shown.
constexpr std::array kSettings = {"Kp", "Ki", "Kd", "Ti", "Td", "b", "c", "delta_r"};

std::string setting_unit(const std::string& name, const ReportInput& s) {
    const std::string gain = unit_quotient(s.u, s.y);
    if (name == "Kp") return gain;
    if (name == "Ki") return gain.empty() ? "" : gain + "/" + s.time;
    if (name == "Kd") return gain.empty() ? "" : gain + " " + s.time;
    if (name == "Ti" || name == "Td") return s.time;
    return name == "delta_r" ? s.y : "";
}

/// In full: the setting is typed as printed here.
constexpr int kFull = 6;

Row setting_row(const std::string& name, const std::string& unit, const std::vector<JsonLocation>& controllers) {
    Row row = {with_unit(name, unit)};
    for (const JsonLocation& place : controllers) {
        const Json& value = place.at(name).value();
        if (value.is_null() && !place.at("why_null").at(name).exists())
            row.push_back(name == "Ti" && place.value().is_object() && place.value().contains("Ti") ? Html("∞")
                                                                                                    : Html(""));
        else
            row.push_back(figure(place.at(name), kFull));
    }
    return row;
}

/// A column of the table: one form of the controller under its heading.
struct Column {
    std::string head;
    JsonLocation controller;
};

Html forms_table(const char* caption, const std::vector<Column>& columns, const ReportInput& s) {
    Row top = {""};
    std::vector<JsonLocation> controllers, filters, leads;
    for (const auto& [head, controller] : columns) {
        top.push_back(head);
        controllers.push_back(controller);
        filters.push_back(controller.at("filter"));
        leads.push_back(controller.at("setpoint_filter"));
    }
    std::vector<Row> rows;
    for (const char* name : kSettings)
        if (any_has(controllers, name)) rows.push_back(setting_row(name, setting_unit(name, s), controllers));
    Row types = {"Filter"};
    bool filtered = false;
    for (const JsonLocation& filter : filters) {
        std::string words = text_at(filter.at("type"));
        filtered = filtered || !words.empty();
        std::ranges::replace(words, '_', ' ');
        types.push_back(words);
    }
    if (filtered) rows.push_back(types);
    for (const char* name : {"Tf", "N"})
        if (any_has(filters, name)) rows.push_back(setting_row(name, *name == 'T' ? s.time : "", filters));
    if (any_has(leads, "T")) {
        Row row = {with_unit("Set-point filter T", s.time)};
        for (const JsonLocation& lead : leads) row.push_back(lead.exists() ? figure(lead.at("T"), kFull) : Html(""));
        rows.push_back(row);
    }
    return table(caption, top, rows);
}

bool is_nonlinear(const ReportInput& s) { return text_at(s.entry.at("controller").at("form")) == "npid"; }

const char* own_form(const ReportInput& s) {
    if (is_nonlinear(s)) return "Nonlinear (NPID)";
    return text_at(s.entry.at("controller").at("form")) == "parallel" ? "Parallel, as given" : "Ideal";
}

/// The product of the new settings: settings that were typed into one stay in it. A result of an older version names
/// it only in the request.
const product::Product* product_of(const ReportInput& s) {
    const std::string own = text_at(s.entry.at("as_entered").at("product"));
    return product::find(own.empty() ? text_at(s.request.at("implement").at("product")) : own);
}

Html typed(const JsonLocation& texts, const std::string& name) {
    const JsonLocation value = texts.at(name);
    return value.exists() ? element("span", text_at(value), {{"data-typed", value.pointer}}) : Html("–");
}

/// True if the new settings are known by the names of the controller's own list.
bool has_typed(const ReportInput& s) {
    return product_of(s) != nullptr && s.entry.at("as_entered").at("as_typed").value().is_object();
}

/// Today's settings by the names of the controller's own list, if they are known in the same product.
std::optional<JsonLocation> entered_today(const ReportInput& s) {
    if (!s.today || !s.today->at("as_entered").at("as_typed").exists()) return std::nullopt;
    const JsonLocation entered = s.today->at("as_entered");
    if (text_at(entered.at("product")) != text_at(s.entry.at("as_entered").at("product"))) return std::nullopt;
    return entered;
}

/// True if a new setting replaces a value that is not known.
bool replaces_unknown(const ReportInput& s, const JsonLocation& today) {
    for (const auto& [name, value] : s.entry.at("as_entered").at("as_typed").value().items())
        if (!today.at("as_typed").at(name).exists()) return true;
    return false;
}

constexpr const char* kToNote = "note it: ______";

/// Today's settings next to the new ones, by the names of the controller's own list.
Html change_table(const product::Product& product, const ReportInput& s, TodayColumn column) {
    const JsonLocation entered = s.entry.at("as_entered"), texts = entered.at("as_typed");
    const std::optional<JsonLocation> before = entered_today(s);
    std::vector<std::string> names;
    for (const auto& [name, value] : texts.value().items()) names.push_back(name);
    if (before)
        for (const auto& [name, value] : before->at("as_typed").value().items())
            if (!texts.at(name).exists()) names.push_back(name);
    std::vector<Row> rows;
    for (const std::string& name : names) {
        const product::Parameter* parameter = product::parameter_named(product, name);
        std::string unit = text_at(entered.at("units").at(name));
        if (unit.empty() && before) unit = text_at(before->at("units").at(name));
        Row row = {with_unit(parameter == nullptr ? name : std::string(parameter->label), unit)};
        if (before)
            row.push_back(before->at("as_typed").at(name).exists() ? typed(before->at("as_typed"), name)
                                                                   : Html(kToNote));
        else if (column == TodayColumn::always)
            row.push_back("");
        row.push_back(typed(texts, name));
        rows.push_back(std::move(row));
    }
    const std::string caption = "On your controller, " + product_title(product);
    return before || column == TodayColumn::always ? table(caption.c_str(), {"", "Today", "New"}, rows)
                                                   : table(caption.c_str(), {"", "Type in"}, rows);
}

/// Today's settings next to the new ones in the ideal form, or in that of a nonlinear controller.
Html ideal_table(const ReportInput& s, TodayColumn column) {
    const bool with_today = s.today || column == TodayColumn::always;
    std::vector<Column> columns;
    if (with_today) columns.push_back({"Today", s.today ? s.today->at("controller") : s.result.at("")});
    columns.push_back({with_today ? "New" : own_form(s), s.entry.at("controller")});
    return forms_table(is_nonlinear(s) ? "To enter, in the nonlinear form" : "To enter, in the ideal form", columns, s);
}

Html from_to(const JsonLocation& low, const JsonLocation& high) {
    return figure(low, kFull) + " to " + figure(high, kFull);
}

/// The member of the user's own controller: that of settings typed into it, else that of `implement`.
JsonLocation device_member(const ReportInput& s, const char* name) {
    const JsonLocation own = s.given.at(name);
    return own.exists() ? own : s.request.at("implement").at(name);
}

/// Spans and sample time for which the typed values are valid, and the limits of u used in the computation.
Html ranges_table(const ReportInput& s) {
    const JsonLocation actuator = s.request.at("evaluate").at("actuator"),
                       sample_time = device_member(s, "sample_time");
    std::vector<Row> rows;
    for (const auto& [label, name, unit] :
         {std::tuple{"Range of the measurement", "y_span", s.y}, std::tuple{"Range of the output", "u_span", s.u}}) {
        const JsonLocation span = device_member(s, name);
        if (span.value().is_array() && span.value().size() == 2)
            rows.push_back({with_unit(label, unit), from_to(span.at(std::size_t{0}), span.at(std::size_t{1}))});
    }
    if (sample_time.exists()) rows.push_back({with_unit("Sample time", s.time), figure(sample_time, kFull)});
    if (actuator.at("min").exists() && actuator.at("max").exists())
        rows.push_back(
            {with_unit("Limits of u, from the operating point", s.u), from_to(actuator.at("min"), actuator.at("max"))});
    return rows.empty() ? Html() : table("Ranges and limits", {"", ""}, rows);
}

Html notes_of(const JsonLocation& entry) {
    const JsonLocation notes = entry.at("as_entered").at("notes");
    std::vector<Html> sentences;
    for (std::size_t i = 0; i < notes.value().size(); ++i) sentences.push_back(text_at(notes.at(i).at("detail")));
    return list(sentences);
}

/// The values that were assumed for those of today's settings that are not known.
Html assumed_today(const ReportInput& s) {
    const std::optional<JsonLocation> today = has_typed(s) ? entered_today(s) : std::nullopt;
    if (!today || !replaces_unknown(s, *today)) return {};
    std::vector<Html> sentences;
    for (std::size_t i = 0; i < today->at("notes").value().size(); ++i)
        if (const JsonLocation note = today->at("notes").at(i); text_at(note.at("code")) == "default")
            sentences.push_back(Html("Today's settings: ") + text_at(note.at("detail")));
    return list(sentences);
}

}  // namespace

std::string product_title(const product::Product& product) {
    const std::string maker(product.maker), name(product.name);
    return name.starts_with(maker) ? name : maker + " " + name;
}

std::string controller_words(const ReportInput& s) {
    if (has_typed(s)) return product_title(*product_of(s));
    return is_nonlinear(s) ? "a nonlinear PID controller" : "";
}

Html settings_section(const ReportInput& s, TodayColumn column) {
    const Html change = has_typed(s) ? change_table(*product_of(s), s, column) : ideal_table(s, column);
    return section("Settings", element("div", change + ranges_table(s), {{"class", "tables"}}) + notes_of(s.entry) +
                                   assumed_today(s));
}

Html way_back_section(const ReportInput& s) {
    const std::optional<JsonLocation> entered = has_typed(s) ? entered_today(s) : s.today;
    const bool known = entered.has_value(), in_part = known && has_typed(s) && replaces_unknown(s, *entered);
    const char* const before =
        in_part ? "Some of today's settings are unknown: before you change anything, write the value of each setting "
                  "marked \"note it\" into the column Today, and compare the others with the controller. "
        : known
            ? "Compare the column Today with the controller before you change anything, and correct it by hand where "
              "they differ. "
            : "Today's settings are unknown: write the controller's values into the column Today before you change "
              "anything. ";
    return section("To go back", element("p", Html(before) + "To go back, enter the values of this column."));
}

Html forms_section(const ReportInput& s) {
    std::vector<Column> columns = {{own_form(s), s.entry.at("controller")}};
    for (const auto& [name, head] : {std::pair{"parallel", "Parallel"}, {"series", "Series"}}) {
        const JsonLocation place = s.entry.at("equivalents").at(name);
        if (place.exists()) columns.push_back({head, place});
    }
    Html tables = forms_table("New settings, by the form of the controller", columns, s);
    if (s.today) tables += forms_table("Today's settings", {{"Settings", s.today->at("controller")}}, s);
    const std::string series = text_at(s.entry.at("equivalents").at("why_null").at("series"));
    const Html why = series.empty() ? Html() : element("p", "No series form: " + series);
    return section("The settings in other forms", element("div", tables, {{"class", "tables"}}) + why);
}

}  // namespace tunewright::api
