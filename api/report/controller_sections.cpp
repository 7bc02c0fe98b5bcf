// Sections about the effect of the settings, and the search that found them.
#include <algorithm>
#include <array>
#include <span>

#include "api/report/figures.h"
#include "api/report/sections.h"
#include "engine/request/entry.h"
#include "engine/tuning/registry.h"

namespace tunewright::api {
namespace {

struct FigureRow {
    const char *label, *place, *unit;
};

constexpr FigureRow kRobustness[] = {{"Ms", "robustness/Ms", ""},
                                     {"Mt", "robustness/Mt", ""},
                                     {"Gain margin", "robustness/gain_margin", ""},
                                     {"Gain may fall to", "robustness/gain_margin_low", ""},
                                     {"Phase margin", "robustness/phase_margin_deg", "°"},
                                     {"Delay margin", "robustness/delay_margin", "time"},
                                     {"Noise gain Mks", "robustness/Mks", "u/y"}};
constexpr FigureRow kLoad[] = {{"IAE", "performance/load/IAE", "y time"},
                               {"ISE", "performance/load/ISE", "y^2 time"},
                               {"ITAE", "performance/load/ITAE", "y time^2"},
                               {"Peak", "performance/load/peak", "y"},
                               {"Recovery time", "performance/load/recovery_time", "time"},
                               {"TV of u", "performance/load/TV", "u"}};
constexpr FigureRow kSetpoint[] = {{"IAE", "performance/setpoint/IAE", "y time"},
                                   {"Overshoot", "performance/setpoint/overshoot_percent", "%"},
                                   {"Rise time", "performance/setpoint/rise_time", "time"},
                                   {"Settling time", "performance/setpoint/settling_time", "time"},
                                   {"First move of u", "performance/setpoint/first_move", "u"},
                                   {"TV of u", "performance/setpoint/TV", "u"}};
/// The figures of a change sheet.
constexpr FigureRow kEffect[] = {{"Load step: IAE", "performance/load/IAE", "y time"},
                                 {"Load step: peak", "performance/load/peak", "y"},
                                 {"Load step: TV of u", "performance/load/TV", "u"},
                                 {"Set-point step: overshoot", "performance/setpoint/overshoot_percent", "%"},
                                 {"Ms", "robustness/Ms", ""}};
/// The figures of the user's own step.
constexpr FigureRow kOwnStep[] = {{"Set point: IAE", "own_step/setpoint/IAE", "y time"},
                                  {"Set point: overshoot", "own_step/setpoint/overshoot", "y"},
                                  {"Set point: settling time", "own_step/setpoint/settling_time", "time"},
                                  {"Load: IAE", "own_step/load/IAE", "y time"},
                                  {"Load: peak", "own_step/load/peak", "y"},
                                  {"Load: recovery time", "own_step/load/recovery_time", "time"},
                                  {"Smallest u", "own_step/u_min", "u"},
                                  {"Largest u", "own_step/u_max", "u"},
                                  {"TV of u", "own_step/travel", "u"},
                                  {"Time at the lower limit of u", "own_step/time_at_min", "time"},
                                  {"Time at the upper limit of u", "own_step/time_at_max", "time"},
                                  {"u needed in the end", "own_step/u_needed", "u"},
                                  {"y in the end", "own_step/y_final", "y"}};
constexpr FigureRow kReplay[] = {{"IAE", "replay/figures/IAE", "y time"},
                                 {"Travel of u", "replay/figures/travel", "u"}};

std::string squared(const std::string& unit) {
    return unit.find_first_of(" /*") == std::string::npos ? unit + "²" : "(" + unit + ")²";
}

std::string unit_of(const FigureRow& row, const ReportInput& s) {
    const std::string unit = row.unit;
    if (unit == "time") return s.time;
    if (unit == "u") return s.u;
    if (unit == "y") return s.y;
    if (unit == "u/y") return unit_quotient(s.u, s.y);
    if (unit == "y time") return s.y.empty() ? "" : s.y + " " + s.time;
    if (unit == "y^2 time") return s.y.empty() ? "" : squared(s.y) + " " + s.time;
    if (unit == "y time^2") return s.y.empty() ? "" : s.y + " " + squared(s.time);
    return unit;
}

/// The limit of the design on this figure, if it has one.
JsonLocation limit_on(const FigureRow& row, const ReportInput& s) {
    const JsonLocation options = s.entry.at("options");
    const std::string_view place = row.place;
    if (place.ends_with("/overshoot_percent")) return options.at("setpoint").at("overshoot");
    const std::string_view name = place.substr(place.rfind('/') + 1);
    const bool limited = std::ranges::any_of(std::array{"Ms", "Mt", "Mks"}, [&](auto one) { return one == name; });
    return limited && options.at(name).value().is_number() ? options.at(name) : options.at("");
}

/// The loop that runs: that of the user's controller if it is known. The entry's verdict is about this one.
JsonLocation running_loop(const JsonLocation& entry) {
    return entry.at("implemented").at("robustness").exists() ? entry.at("implemented") : entry;
}

/// True if the verdict says that the loop that runs exceeds the design's limit on this figure.
bool exceeds_limit(const FigureRow& row, const ReportInput& s) {
    const Json& verdict = s.entry.at("verdict").value();
    if (!verdict.is_array()) return false;
    const std::string place = row.place, name = place.substr(place.rfind('/') + 1);
    return std::ranges::any_of(verdict, [&](const Json& finding) {
        const std::string code = finding.value("code", "");
        const Json figures = finding.value("figures", Json::object());
        if (code == "overshoot")
            return name == "overshoot_percent" &&
                   (figures.contains("asked_percent") || figures.contains("design_percent"));
        return code == "above-limit" && figures.contains(name + "_limit");
    });
}

/// A column of a table of figures: a loop under its heading.
struct LoopColumn {
    const char* head;
    JsonLocation loop;

    JsonLocation at(const FigureRow& row) const { return {loop.root, loop.pointer + "/" + row.place}; }
    bool has(const FigureRow& row) const { return loop.root.contains(Json::json_pointer(at(row).pointer)); }
};

std::vector<LoopColumn> report_columns(const ReportInput& s) {
    std::vector<LoopColumn> out = {{"Proposal", s.entry}};
    if (s.entry.at("implemented").exists()) out.push_back({"Implemented", s.entry.at("implemented")});
    if (!s.today) return out;
    out.push_back({"Today", *s.today});
    if (s.today->at("implemented").exists()) out.push_back({"Today, implemented", s.today->at("implemented")});
    return out;
}

/// Today's loop and the new one, each with the user's own controller if it is known.
std::vector<LoopColumn> effect_columns(const ReportInput& s) {
    std::vector<LoopColumn> out;
    if (s.today) out.push_back({"Today", running_loop(*s.today)});
    out.push_back({"New", running_loop(s.entry)});
    return out;
}

Row heads_of(const std::vector<LoopColumn>& columns) {
    Row heads = {""};
    for (const LoopColumn& column : columns) heads.push_back(column.head);
    return heads;
}

/// One row for each figure that a column has.
std::vector<Row> figure_rows(std::span<const FigureRow> rows, const std::vector<LoopColumn>& columns,
                             const ReportInput& s) {
    std::vector<Row> out;
    for (const FigureRow& row : rows) {
        if (std::ranges::none_of(columns, [&](const LoopColumn& column) { return column.has(row); })) continue;
        const JsonLocation limit = limit_on(row, s);
        Row line = {with_unit(row.label, unit_of(row, s))};
        if (limit.exists()) line[0] += ", limit: " + figure(limit);
        for (const LoopColumn& column : columns) {
            const bool marked = column.loop.pointer == running_loop(s.entry).pointer && exceeds_limit(row, s);
            line.push_back(marked ? figure(column.at(row)) + " " + element("strong", "above the limit")
                                  : figure(column.at(row)));
        }
        out.push_back(std::move(line));
    }
    return out;
}

/// Empty if `judged`, one of the columns, has none of the figures.
Html figure_table(const char* caption, std::span<const FigureRow> rows, const std::vector<LoopColumn>& columns,
                  const LoopColumn& judged, const ReportInput& s) {
    if (std::ranges::none_of(rows, [&](const FigureRow& row) { return judged.has(row); })) return {};
    return table(caption, heads_of(columns), figure_rows(rows, columns, s));
}

/// The recorded time as it was, and with each of these loops; empty if the entry has no replay.
Html replay_table(const ReportInput& s) {
    if (!s.entry.at("replay").at("figures").exists()) return {};
    std::vector<LoopColumn> columns = {{"Recorded", s.result}};
    if (s.today && s.today->at("replay").at("figures").exists()) columns.push_back({"Today", *s.today});
    columns.push_back({"New", s.entry});
    Row ratios = {"IAE, divided by the record's", "1"};
    for (std::size_t i = 1; i < columns.size(); ++i) {
        const JsonLocation replay = columns[i].loop.at("replay");
        ratios.push_back(figure(replay.at("IAE_ratio"), 3) + " (" + figure(replay.at("IAE_ratio_low"), 3) + " to " +
                         figure(replay.at("IAE_ratio_high"), 3) + ")");
    }
    std::vector<Row> rows = figure_rows(kReplay, columns, s);
    rows.insert(rows.begin(), ratios);
    return table("Replay of the record", heads_of(columns), rows);
}

/// Ms of the loop that runs over all plants for which the entry is designed; empty if there is only one.
Html worst_case(const ReportInput& s) {
    const JsonLocation region = running_loop(s.entry).at("region");
    if (!region.at("worst_Ms").exists()) return {};
    return element("p", Html("Over the whole uncertainty, Ms is at worst ") + figure(region.at("worst_Ms")) +
                            "; the share of plants with a stable loop is " + figure(region.at("stable_fraction")) +
                            ".");
}

Html instability(const ReportInput& s) {
    if (s.entry.at("robustness").at("stable").value() != false) return {};
    return element("p", element("strong", "The loop is unstable with these settings."));
}

Html verdict_line(const Json& finding) {
    return element("li", finding.value("text", ""), {{"class", finding.value("level", "note")}});
}

/// "200 degC" for a member of the user's own step; 0 if it is left out.
std::string amount(const JsonLocation& place, const std::string& unit) {
    const Json& value = place.value();
    return number_text(value.is_number() ? value.get<double>() : 0, 6) + (unit.empty() ? "" : " " + unit);
}

/// The load of the user's own step in a sentence; "" without one.
std::string load_words(const JsonLocation& load, const ReportInput& s) {
    if (!load.exists()) return "";
    const bool at_output = text_at(load.at("at")) == "output";
    const std::string shape = text_at(load.at("shape"));
    std::string words = " A load of " + amount(load.at("size"), at_output ? s.y : s.u) + " at the plant's " +
                        (at_output ? "output" : "input") + " follows";
    if (shape == "pulse") words += ", for " + amount(load.at("duration"), s.time);
    if (shape == "ramp") words += ", rising over " + amount(load.at("duration"), s.time);
    return words + ".";
}

/// The user's own step in sentences.
std::string step_words(const JsonLocation& step, const ReportInput& s) {
    std::string words = "From rest at y = " + amount(step.at("y"), s.y) + " and u = " + amount(step.at("u"), s.u) +
                        " the set point goes to " + amount(step.at("target"), s.y);
    if (step.at("ramp_rate").exists())
        words += ", by " + amount(step.at("ramp_rate"), s.y) + " per " + (s.time.empty() ? "unit of time" : s.time);
    words += "." + load_words(step.at("load"), s);
    if (step.at("u_min").exists()) words += " u is at least " + amount(step.at("u_min"), s.u) + ".";
    if (step.at("u_max").exists()) words += " u is at most " + amount(step.at("u_max"), s.u) + ".";
    return words;
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

/// "load iae" for "load_iae".
std::string in_words(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::string value_text(const Json& value) {
    if (value.is_object()) {
        std::string parts;
        for (const auto& [name, part] : value.items())
            parts += (parts.empty() ? "" : ", ") + in_words(name) + " " + value_text(part);
        return parts;
    }
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    return value.is_string()   ? in_words(value.get<std::string>())
           : value.is_number() ? number_text(value.get<double>(), 6)
                               : value.dump();
}

/// True for an option that only adds data for the page's plots.
bool only_draws(const std::string& method, const std::string& option) {
    const TuningMethod* described = find_method(method);
    return described != nullptr && std::ranges::any_of(described->options, [&](const OptionDescription& one) {
               return one.name == option && one.draws;
           });
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

Html reason_section(const ReportInput& s) {
    const Json& findings = s.entry.at("verdict").value();
    if (!findings.is_array() || findings.empty()) return {};
    Html lines = verdict_line(findings.front());
    for (std::size_t i = 1; i < findings.size(); ++i) {
        const std::string level = findings[i].value("level", "");
        if (level == "warning" || level == "bad" || findings[i].value("code", "") == "overshoot")
            lines += verdict_line(findings[i]);
    }
    return section("Why", element("ul", lines, {{"class", "verdict"}}));
}

Html figures_section(const ReportInput& s) {
    const std::vector<LoopColumn> columns = report_columns(s);
    const auto each = [&](const char* caption, std::span<const FigureRow> rows) {
        return figure_table(caption, rows, columns, columns.front(), s);
    };
    const Html tables = each("Margins", kRobustness) + each("Load step", kLoad) + each("Set-point step", kSetpoint);
    return section("Figures", element("div", tables, {{"class", "tables"}}) + instability(s) + worst_case(s));
}

Html own_step_section(const ReportInput& s) {
    const JsonLocation step = s.request.at("evaluate").at("own_step");
    if (!step.exists() || !s.entry.at("own_step").exists()) return {};
    const Html words = element("p", step_words(step, s));
    const JsonLocation refused = s.entry.at("own_step").at("refused");
    if (refused.exists()) return section("Your own step", words + element("p", text_at(refused.at("text"))));
    std::vector<LoopColumn> columns = {{"Proposal", s.entry}};
    if (s.today && s.today->at("own_step").at("u_min").exists()) columns.push_back({"Today", *s.today});
    std::vector<FigureRow> rows;
    for (const FigureRow& row : kOwnStep) {
        const std::string_view place = row.place;
        const bool at_limit = place.ends_with("time_at_min") || place.ends_with("time_at_max");
        if (!at_limit || step.at(place.ends_with("min") ? "u_min" : "u_max").exists()) rows.push_back(row);
    }
    const Html figures = figure_table("Figures of the step", rows, columns, columns.front(), s);
    Html drawings;
    for (const Plot& plot : own_step_plots(s)) drawings += drawn(plot);
    return section("Your own step", words + element("div", figures, {{"class", "tables"}}) +
                                        element("div", drawings, {{"class", "figures"}}));
}

Html effect_section(const ReportInput& s) {
    const std::vector<LoopColumn> columns = effect_columns(s);
    const Html tables = figure_table("On the model", kEffect, columns, columns.back(), s) + replay_table(s);
    const Html words = instability(s) + worst_case(s);
    if (tables.empty() && words.empty()) return {};
    return section("Expected effect",
                   element("div", element("div", tables + words) + effect_drawing(s), {{"class", "figures"}}));
}

Html method_section(const ReportInput& s) {
    const std::string method = text_at(s.entry.at("method"));
    Html out = element("p", element("strong", text_at(s.entry.at("title"))) + (method == kGivenMethod ? ": " : ". ") +
                                text_at(s.entry.at("source")));
    std::vector<Html> options;
    if (s.entry.at("options").value().is_object())
        for (const auto& [name, value] : s.entry.at("options").value().items())
            if (!value.is_null() && !only_draws(method, name))
                options.push_back(in_words(name) + " " + value_text(value));
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
