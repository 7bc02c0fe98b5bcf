// The report of an operating range: one setting and the schedule, the curves over the range, the runs across it.
#include <algorithm>
#include <tuple>

#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

/// In full: the setting is typed as printed here.
constexpr int kTyped = 6;

/// The label of the scheduling variable: "load (%)".
std::string scheduling_label(const ReportInput& s) {
    const JsonLocation scheduling = s.entry.at("scheduling");
    return with_unit(text_at(scheduling.at("name")), text_at(scheduling.at("unit")));
}

Html verdict_of(const ReportInput& s) {
    Html out;
    const std::string verdict = text_at(s.entry.at("verdict").at("text"));
    if (!verdict.empty()) out += element("p", element("strong", verdict));
    if (s.result.at("partial").value() == true)
        out += element("p", "The search was stopped before its end; this is the best result until then.");
    std::vector<Html> remarks;
    for (const Json& warning : s.entry.at("warnings").value()) remarks.emplace_back(warning.value("detail", ""));
    for (const Json& reason : s.entry.at("why_null").value())
        if (reason.is_string()) remarks.emplace_back(reason.get<std::string>());
    return section("Verdict", out + list(remarks));
}

Row settings_row(const Html& head, const JsonLocation& controller, const JsonLocation& Tf) {
    Row row{head};
    for (const char* name : {"Kp", "Ti", "Td"}) row.push_back(figure(controller.at(name), kTyped));
    row.push_back(Tf.exists() ? figure(Tf, kTyped) : Html("0"));
    row.push_back(controller.at("b").exists() ? figure(controller.at("b"), kTyped) : Html(""));
    return row;
}

std::string interpolation_of(const JsonLocation& schedule) {
    const std::string word = text_at(schedule.at("interpolation"));
    if (word == "steps")
        return "A row's settings are used from its place on; the controller changes to the next row only half the "
               "hysteresis beyond its border. Hysteresis: ";
    return word == "linear_in_times"
               ? "Between rows Kp, Ti, Td, Tf and b are linear; beyond the first and the last row they are constant."
               : "Between rows Kp, 1/Ti, Td, Tf and b are linear; beyond the first and the last row they are constant.";
}

Html settings_of(const ReportInput& s) {
    const Row heads{scheduling_label(s),     with_unit("Kp", unit_quotient(s.u, s.y)),
                    with_unit("Ti", s.time), with_unit("Td", s.time),
                    with_unit("Tf", s.time), "b"};
    Html out;
    const JsonLocation schedule = s.entry.at("schedule"), one = s.entry.at("one").at("controller");
    if (schedule.exists()) {
        std::vector<Row> rows;
        const JsonLocation list = schedule.at("rows");
        for (std::size_t k = 0; k < list.value().size(); ++k)
            rows.push_back(settings_row(figure(list.at(k).at("at"), kTyped), list.at(k), list.at(k).at("Tf")));
        Html how = interpolation_of(schedule);
        if (text_at(schedule.at("interpolation")) == "steps") how += figure(schedule.at("hysteresis")) + Html(".");
        out += table("The schedule", heads, rows) + element("p", how);
    }
    if (one.exists())
        out += table("One setting for the whole range", heads, {settings_row("all", one, one.at("filter").at("Tf"))});
    return section("Settings", out + element("p",
                                             "Ideal form: Kp (1 + 1/(s Ti) + s Td), the measurement filtered by "
                                             "1/(1 + s Tf + (s Tf)²/2), set-point weight b."));
}

/// The worst place of each figure, with one setting and with the schedule if both exist.
Html worst_of(const ReportInput& s) {
    std::vector<Row> rows;
    for (const auto& [member, name] : {std::pair{"schedule", "Schedule"}, {"one", "One setting"}}) {
        const JsonLocation worst = s.entry.at("worst").at(member);
        for (std::size_t k = 0; k < worst.value().size(); ++k) {
            const std::string quantity = text_at(worst.at(k).at("quantity"));
            rows.push_back(
                {std::string(name) + ": " + (quantity == "relative_IAE" ? "IAE relative to its own optimum" : quantity),
                 figure(worst.at(k).at("value")), figure(worst.at(k).at("limit")), figure(worst.at(k).at("at"))});
        }
    }
    return section("Worst places",
                   table("Recomputed on finer grids", {"", "Largest", "Limit", scheduling_label(s)}, rows));
}

Plot over_range(const ReportInput& s, const std::string& title, const std::string& label) {
    return {.title = title, .x_label = scheduling_label(s), .y_label = label, .traces = {}};
}

void add_curve(Plot& plot, const JsonLocation& curves, const JsonLocation& curve, const std::string& name, Line line) {
    if (curve.exists())
        plot.traces.push_back({.name = name, .line = line, .x = numbers_at(curves.at("at")), .y = numbers_at(curve)});
}

Html curves_of(const ReportInput& s) {
    const JsonLocation curves = s.entry.at("curves");
    Html out;
    for (const auto& [member, title, label] :
         {std::tuple{"Ms", "Ms over the range", "Ms"}, std::tuple{"Mt", "Mt over the range", "Mt"},
          std::tuple{"relative_IAE", "IAE relative to the place's own optimum", "IAE ratio"}}) {
        Plot plot = over_range(s, title, label);
        add_curve(plot, curves, curves.at("schedule").at(member), "Schedule", Line::proposal);
        add_curve(plot, curves, curves.at("one").at(member), "One setting", Line::today);
        const Json& limit =
            s.entry.at("worst").at("schedule").at(std::string(member) == "Mt" ? 1 : 0).at("limit").value();
        if (std::string(member) != "relative_IAE" && limit.is_number())
            plot.limits.emplace_back("Limit", limit.get<double>());
        out += drawn(plot);
    }
    for (const auto& [member, unit] :
         {std::pair<const char*, std::string>{"Kp", unit_quotient(s.u, s.y)}, {"Ti", s.time}, {"Td", s.time}}) {
        Plot plot = over_range(s, std::string(member) + " of the schedule", with_unit(member, unit));
        add_curve(plot, curves, curves.at("schedule").at(member), "Schedule", Line::proposal);
        out += drawn(plot);
    }
    for (const auto& [member, unit] :
         {std::pair<const char*, std::string>{"K", unit_quotient(s.y, s.u)}, {"T", s.time}, {"L", s.time}}) {
        Plot plot = over_range(s, std::string(member) + " of the plant", with_unit(member, unit));
        add_curve(plot, curves, curves.at(member), "Plant", Line::second);
        out += drawn(plot);
    }
    return section("Over the range",
                   element("div", out, {{"class", "figures"}}) + element("p", text_at(s.entry.at("stated"))));
}

Html points_of(const ReportInput& s) {
    const JsonLocation points = s.entry.at("one").at("points");
    std::vector<Row> rows;
    for (std::size_t k = 0; k < points.value().size(); ++k) {
        const JsonLocation point = points.at(k);
        Row row{figure(point.at("at"), kTyped)};
        for (const char* name : {"Kp", "Ti", "Td"}) row.push_back(figure(point.at("own").at(name)));
        for (const char* name : {"relative_IAE", "Ms", "Mt"}) row.push_back(figure(point.at(name)));
        rows.push_back(row);
    }
    if (rows.empty()) return {};
    return section("One setting at the points",
                   table("Each point's own optimum, and the figures of the one setting there",
                         {scheduling_label(s), "own Kp", with_unit("own Ti", s.time), with_unit("own Td", s.time),
                          "IAE ratio", "Ms", "Mt"},
                         rows));
}

Html run_of(const JsonLocation& run, const ReportInput& s) {
    Html drawings;
    for (const auto& [signal, unit] : {std::pair{"y", s.y}, std::pair{"u", s.u}}) {
        Plot plot{.title = signal, .x_label = with_unit("t", s.time), .y_label = with_unit(signal, unit), .traces = {}};
        for (const auto& [member, name, line] :
             {std::tuple{"schedule", "Schedule", Line::proposal}, std::tuple{"one", "One setting", Line::today},
              std::tuple{"nonlinear", "Nonlinear controller", Line::built}}) {
            std::vector<double> t = numbers_at(run.at("t")), values = numbers_at(run.at(member).at(signal));
            t.resize(std::min(t.size(), values.size()));  // a run that ended early is shorter
            values.resize(t.size());
            if (!t.empty())
                plot.traces.push_back({.name = name, .line = line, .x = std::move(t), .y = std::move(values)});
        }
        if (*signal == 'y' && text_at(s.request.at("range").at("along")) != "parameter")
            plot.traces.push_back({.name = "Set point",
                                   .line = Line::setpoint,
                                   .x = numbers_at(run.at("t")),
                                   .y = numbers_at(run.at("target"))});
        drawings += drawn(plot);
    }
    return element("h3", text_at(run.at("name"))) + element("div", drawings, {{"class", "figures"}});
}

Html runs_of(const ReportInput& s) {
    const JsonLocation runs = s.entry.at("runs");
    Html out;
    for (std::size_t k = 0; k < runs.value().size(); ++k) out += run_of(runs.at(k), s);
    return out.empty() ? Html() : section("Runs across the range, on the equations", out);
}

}  // namespace

Html range_sections(const ReportInput& subject) {
    return verdict_of(subject) + settings_of(subject) + worst_of(subject) + curves_of(subject) + points_of(subject) +
           runs_of(subject);
}

}  // namespace tunewright::api
