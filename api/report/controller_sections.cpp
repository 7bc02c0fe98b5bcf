// Sections about the effect of the settings, and the search that found them.
#include <algorithm>
#include <array>

#include "api/report/figures.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

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

std::string unit_of(const FigureRow& row, const ReportInput& s) {
    const std::string unit = row.unit;
    if (unit == "time") return s.time;
    if (unit == "u") return s.u;
    if (unit == "y") return s.y;
    if (unit == "u/y") return unit_quotient(s.u, s.y);
    if (unit == "y time") return s.y.empty() ? "" : s.y + " " + s.time;
    return unit;
}

/// The limit of the design on this figure, if it has one.
JsonLocation limit_on(const FigureRow& row, const ReportInput& s) {
    const JsonLocation options = s.entry.at("options");
    if (std::string_view(row.place) == "overshoot_percent") return options.at("setpoint").at("overshoot");
    const bool limited =
        std::ranges::any_of(std::array{"Ms", "Mt", "Mks"}, [&](std::string_view one) { return one == row.place; });
    return limited && options.at(row.place).value().is_number() ? options.at(row.place) : options.at("");
}

template <std::size_t n>
Html figure_table(const char* caption, const FigureRow (&rows)[n], const std::string& below, const ReportInput& s) {
    const auto places = [&](const JsonLocation& owner) {
        return JsonLocation{owner.root, owner.pointer + "/" + below};
    };
    Row heads = {"", "Proposal"};
    std::vector<JsonLocation> columns = {places(s.entry)};
    if (s.entry.at("implemented").exists()) {
        heads.push_back("Implemented");
        columns.push_back(places(s.entry.at("implemented")));
    }
    if (s.today) {
        heads.push_back("Today");
        columns.push_back(places(*s.today));
        if (s.today->at("implemented").exists()) {
            heads.push_back("Today, implemented");
            columns.push_back(places(s.today->at("implemented")));
        }
    }
    if (!columns.front().exists()) return {};
    std::vector<Row> out;
    for (const FigureRow& row : rows) {
        if (!any_has(columns, row.place)) continue;
        const JsonLocation limit = limit_on(row, s);
        Row line = {with_unit(row.label, unit_of(row, s))};
        if (limit.exists()) line[0] += ", limit: " + figure(limit);
        for (const JsonLocation& column : columns) line.push_back(figure(column.at(row.place)));
        out.push_back(std::move(line));
    }
    return table(caption, heads, out);
}

Html verdict_line(const Json& finding) {
    return element("li", finding.value("text", ""), {{"class", finding.value("level", "note")}});
}

bool same_finding(const Json& a, const Json& b) {
    return a.value("code", "") == b.value("code", "") && a.value("figures", Json()) == b.value("figures", Json());
}

/// True if the entry's own verdict already says what this finding about all entries says: the same finding, the choice
/// of this entry, or that the only design must not be entered.
bool is_own(const Json& finding, const Json& own, const ReportInput& s) {
    const std::string code = finding.value("code", "");
    if (std::ranges::any_of(own, [&](const Json& one) { return same_finding(one, finding); })) return true;
    if (code == "take")
        return finding.value("figures", Json::object()).value("entry", -1.0) == static_cast<double>(s.index);
    const Json& entries = s.result.at("controllers").value();
    return code == "none" && std::ranges::count_if(entries, [](const Json& entry) {
                                 return entry.value("method", "") != "baseline";
                             }) == 1;
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

Html verdict_section(const ReportInput& s) {
    const Json &own = s.entry.at("verdict").value(), &all = s.result.at("verdict").value();
    Html lines;
    if (own.is_array())
        for (const Json& finding : own) lines += verdict_line(finding);
    if (all.is_array())
        for (const Json& finding : all)
            if (!own.is_array() || !is_own(finding, own, s)) lines += verdict_line(finding);
    return section("Verdict", lines.empty() ? lines : element("ul", lines, {{"class", "verdict"}}));
}

Html figures_section(const ReportInput& s) {
    const Html tables = figure_table("Margins", kRobustness, "robustness", s) +
                        figure_table("Load step", kLoad, "performance/load", s) +
                        figure_table("Set-point step", kSetpoint, "performance/setpoint", s);
    Html more;
    const JsonLocation stable = s.entry.at("robustness").at("stable");
    if (stable.value() == false) more += element("p", element("strong", "The loop is unstable with these settings."));
    const JsonLocation region = s.entry.at("region");
    if (region.at("worst_Ms").exists())
        more += element("p", Html("Over the whole uncertainty, Ms is at worst ") + figure(region.at("worst_Ms")) +
                                 "; the share of plants with a stable loop is " + figure(region.at("stable_fraction")) +
                                 ".");
    return section("Figures", element("div", tables, {{"class", "tables"}}) + more);
}

Html method_section(const ReportInput& s) {
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
    for (const JsonLocation& owner : {s.entry, s.result})
        for (std::size_t i = 0; i < owner.at("warnings").value().size(); ++i)
            warnings.push_back(text_at(owner.at("warnings").at(i).at("detail")));
    if (!warnings.empty()) out += element("h3", "Warnings") + list(warnings);
    return section("Method", out);
}

}  // namespace tunewright::api
