// What is to be entered, what it does, and how it was found.
#include <algorithm>
#include <array>

#include "api/report/figures.h"

namespace tunewright::api {
namespace {

/// Members of a controller in the order in which they are read.
constexpr std::array kSettings = {"Kp", "Ki", "Kd", "Ti", "Td", "b", "c", "delta_r"};

std::string setting_unit(const std::string& name, const ReportSubject& s) {
    const std::string gain = unit_quotient(s.u, s.y);
    if (name == "Kp") return gain;
    if (name == "Ki") return gain.empty() ? "" : gain + "/" + s.time;
    if (name == "Kd") return gain.empty() ? "" : gain + " " + s.time;
    if (name == "Ti" || name == "Td") return s.time;
    return name == "delta_r" ? s.y : "";
}

/// In full: a setting is typed as it stands here.
constexpr int kFull = 6;

Row setting_row(const std::string& name, const std::string& unit, const std::vector<Place>& controllers) {
    Row row = {with_unit(name, unit)};
    for (const Place& place : controllers) {
        const Json& value = place.at(name).value();
        if (value.is_null() && !place.at("why_null").at(name).exists())
            row.push_back(name == "Ti" && place.value().is_object() && place.value().contains("Ti") ? Html("∞")
                                                                                                    : Html(""));
        else
            row.push_back(figure(place.at(name), kFull));
    }
    return row;
}

bool any_has(const std::vector<Place>& controllers, const std::string& name) {
    for (const Place& controller : controllers)
        if (controller.value().is_object() && controller.value().contains(name)) return true;
    return false;
}

Html settings_table(const char* caption, const std::vector<std::string>& heads, const std::vector<Place>& controllers,
                    const ReportSubject& s) {
    Row top = {""};
    for (const std::string& head : heads) top.push_back(head);
    std::vector<Row> rows;
    for (const char* name : kSettings)
        if (any_has(controllers, name)) rows.push_back(setting_row(name, setting_unit(name, s), controllers));
    std::vector<Place> filters, leads;
    for (const Place& controller : controllers) {
        filters.push_back(controller.at("filter"));
        leads.push_back(controller.at("setpoint_filter"));
    }
    Row types = {"Filter"};
    bool filtered = false;
    for (const Place& filter : filters) {
        const std::string type = text_at(filter.at("type"));
        filtered = filtered || !type.empty();
        std::string words = type;
        for (char& c : words) c = c == '_' ? ' ' : c;
        types.push_back(words);
    }
    if (filtered) rows.push_back(types);
    for (const char* name : {"Tf", "N"})
        if (any_has(filters, name)) rows.push_back(setting_row(name, *name == 'T' ? s.time : "", filters));
    if (any_has(leads, "T")) {
        Row row = {with_unit("Set-point filter T", s.time)};
        for (const Place& lead : leads) row.push_back(lead.exists() ? figure(lead.at("T"), kFull) : Html(""));
        rows.push_back(row);
    }
    return table(caption, top, rows);
}

Html entered(const Place& entry, const char* caption) {
    const Place as = entry.at("as_entered");
    if (!as.at("as_typed").value().is_object()) return {};
    std::vector<Row> rows;
    for (const auto& [name, text] : as.at("as_typed").value().items()) {
        Row row = {with_unit(name, text_at(as.at("units").at(name)))};
        row.push_back(element("span", text.is_string() ? text.get<std::string>() : text.dump(),
                              {{"data-typed", as.at("as_typed").at(name).pointer}}));
        rows.push_back(row);
    }
    std::vector<Html> notes;
    for (std::size_t i = 0; i < as.at("notes").value().size(); ++i)
        notes.push_back(text_at(as.at("notes").at(i).at("detail")));
    return element("div", table(caption, {"Setting", "Type in"}, rows) + list(notes));
}

struct FigureRow {
    const char *label, *place, *unit;
};

constexpr FigureRow kRobustness[] = {{"Ms", "Ms", ""},
                                     {"Mt", "Mt", ""},
                                     {"Gain margin", "gain_margin", ""},
                                     {"Gain may fall to", "gain_margin_low", ""},
                                     {"Phase margin", "phase_margin_deg", "°"},
                                     {"Delay margin", "delay_margin", "time"},
                                     {"Noise gain Mks", "Mks", "u/y"}};
constexpr FigureRow kLoad[] = {{"IAE", "IAE", "y time"},
                               {"ISE", "ISE", ""},
                               {"ITAE", "ITAE", ""},
                               {"Peak", "peak", "y"},
                               {"Recovery time", "recovery_time", "time"},
                               {"TV of u", "TV", "u"}};
constexpr FigureRow kSetpoint[] = {{"IAE", "IAE", "y time"},
                                   {"Overshoot", "overshoot_percent", "%"},
                                   {"Rise time", "rise_time", "time"},
                                   {"Settling time", "settling_time", "time"},
                                   {"First move of u", "first_move", "u"},
                                   {"TV of u", "TV", "u"}};

std::string unit_of(const FigureRow& row, const ReportSubject& s) {
    const std::string unit = row.unit;
    if (unit == "time") return s.time;
    if (unit == "u") return s.u;
    if (unit == "y") return s.y;
    if (unit == "u/y") return unit_quotient(s.u, s.y);
    if (unit == "y time") return s.y.empty() ? "" : s.y + " " + s.time;
    return unit;
}

template <std::size_t n>
Html figure_table(const char* caption, const FigureRow (&rows)[n], const std::string& below, const ReportSubject& s) {
    const auto places = [&](const Place& owner) { return Place{owner.root, owner.pointer + "/" + below}; };
    Row heads = {"", "Proposal"};
    std::vector<Place> columns = {places(s.entry)};
    if (s.entry.at("implemented").exists()) {
        heads.push_back("As built");
        columns.push_back(places(s.entry.at("implemented")));
    }
    if (s.today) {
        heads.push_back("Today");
        columns.push_back(places(*s.today));
        if (s.today->at("implemented").exists()) {
            heads.push_back("Today, as built");
            columns.push_back(places(s.today->at("implemented")));
        }
    }
    if (!columns.front().exists()) return {};
    std::vector<Row> out;
    for (const FigureRow& row : rows) {
        if (!any_has(columns, row.place)) continue;
        Row line = {with_unit(row.label, unit_of(row, s))};
        for (const Place& column : columns) line.push_back(figure(column.at(row.place)));
        out.push_back(std::move(line));
    }
    return table(caption, heads, out);
}

/// Lines of a verdict, without those that end as one of `said` does.
Html verdict_lines(const Json& verdict, const Json& said) {
    Html items;
    const auto repeats = [&](const std::string& line) {
        return said.is_array() && std::ranges::any_of(said, [&](const Json& one) {
                   return line.ends_with(one.value("text", std::string("?")));
               });
    };
    if (!verdict.is_array()) return items;
    for (const Json& one : verdict) {
        const std::string line = one.value("text", "");
        if (!repeats(line)) items += element("li", line, {{"class", one.value("level", "note")}});
    }
    return items;
}

std::string value_text(const Json& value) {
    if (value.is_object()) {
        std::string parts;
        for (const auto& [name, part] : value.items())
            parts += (parts.empty() ? "" : ", ") + name + " " + value_text(part);
        return parts;
    }
    return value.is_string()   ? value.get<std::string>()
           : value.is_number() ? number_text(value.get<double>(), 6)
                               : value.dump();
}

}  // namespace

Html verdict_section(const ReportSubject& s) {
    const Json &own = s.entry.at("verdict").value(), &all = s.result.at("verdict").value();
    const Html lines = verdict_lines(own, {}) + verdict_lines(all, own);
    return section("Verdict", lines.empty() ? lines : element("ul", lines, {{"class", "verdict"}}));
}

Html settings_section(const ReportSubject& s) {
    std::vector<std::string> heads = {"Ideal"};
    const std::string form = text_at(s.entry.at("controller").at("form"));
    if (form == "npid") heads = {"Nonlinear (NPID)"};
    if (form == "parallel") heads = {"Parallel, as given"};
    std::vector<Place> forms = {s.entry.at("controller")};
    for (const auto& [name, head] : {std::pair{"parallel", "Parallel"}, {"series", "Series"}}) {
        const Place place = s.entry.at("equivalents").at(name);
        if (!place.exists()) continue;
        heads.emplace_back(head);
        forms.push_back(place);
    }
    Html tables = settings_table("To enter, by the form of the controller", heads, forms, s);
    tables += entered(s.entry, "On your controller");
    if (s.today) {
        tables += settings_table("Today", {"Settings"}, {s.today->at("controller")}, s);
        tables += entered(*s.today, "Today, on your controller");
    }
    Html why;
    const std::string series = text_at(s.entry.at("equivalents").at("why_null").at("series"));
    if (!series.empty()) why = element("p", "No series form: " + series);
    return section("Settings", element("div", tables, {{"class", "tables"}}) + why);
}

Html figures_section(const ReportSubject& s) {
    const Html tables = figure_table("Margins", kRobustness, "robustness", s) +
                        figure_table("Load step", kLoad, "performance/load", s) +
                        figure_table("Set-point step", kSetpoint, "performance/setpoint", s);
    Html more;
    const Place stable = s.entry.at("robustness").at("stable");
    if (stable.value() == false) more += element("p", element("strong", "The loop is unstable with these settings."));
    const Place region = s.entry.at("region");
    if (region.at("worst_Ms").exists())
        more += element("p", Html("Over the whole uncertainty, Ms is at worst ") + figure(region.at("worst_Ms")) +
                                 "; the share of them on which the loop is stable is " +
                                 figure(region.at("stable_fraction")) + ".");
    return section("Figures", element("div", tables, {{"class", "tables"}}) + more);
}

Html method_section(const ReportSubject& s) {
    Html out = element("p", element("strong", text_at(s.entry.at("title"))) + " (" + text_at(s.entry.at("method")) +
                                "). " + text_at(s.entry.at("source")));
    std::vector<Html> options;
    if (s.entry.at("options").value().is_object())
        for (const auto& [name, value] : s.entry.at("options").value().items())
            if (!value.is_null()) options.push_back(name + " " + value_text(value));
    Html line;
    for (const Html& option : options) line += (line.empty() ? Html("Options: ") : Html("; ")) + option;
    if (!line.empty()) out += element("p", line);
    std::vector<Html> warnings;
    for (const Place& owner : {s.entry, s.result})
        for (std::size_t i = 0; i < owner.at("warnings").value().size(); ++i)
            warnings.push_back(text_at(owner.at("warnings").at(i).at("detail")));
    if (!warnings.empty()) out += element("h3", "Warnings") + list(warnings);
    return section("Method", out);
}

}  // namespace tunewright::api
