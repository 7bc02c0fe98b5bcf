// The report of loops around the loop: conclusions, settings, figures, responses and peaks.
#include <algorithm>
#include <array>
#include <utility>

#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/sections.h"
#include "api/report/structure/structure_words.h"

namespace tunewright::api {
namespace {

/// In full: the settings are typed as printed here.
constexpr int kTypedDigits = 6;
constexpr std::array kSeriesLines = {Line::proposal, Line::today, Line::built,
                                     Line::second,   Line::limit, Line::setpoint};

JsonLocation place_of(const ReportInput& s, const std::string& pointer) {
    return {s.result.root, s.result.pointer + pointer};
}

Html conclusions_of(const ReportInput& s) {
    std::vector<Html> sentences;
    for (const Json& conclusion : s.result.at("verdict").value())
        sentences.emplace_back(conclusion_sentence(conclusion, {s.time, s.y}));
    if (s.result.at("partial").value() == true)
        sentences.emplace_back("The search was stopped before its end; this is the best result until then.");
    return section("Verdict", list(sentences));
}

/// Settings other than those of PID controllers: compensators, predictor, level controller.
Html other_settings(const ReportInput& s, const std::string& structure) {
    const auto numbers = [&](const JsonLocation& at, std::initializer_list<const char*> names) {
        Row row;
        for (const char* name : names) row.push_back(figure(at.at(name), kTypedDigits));
        return row;
    };
    if (structure == "level")
        return table("The level controller", {"Kc", with_unit("Ti", s.time), "Damping"},
                     {numbers(s.result.at("design"), {"Kc", "Ti", "zeta"})});
    if (structure == "predictor") {
        std::vector<Row> rows;
        for (const char* name : {"lambda", "Tf", "beta"})
            if (s.result.at(name).exists()) rows.push_back({name, figure(s.result.at(name), kTypedDigits)});
        for (const char* part : {"C", "F"})
            for (const char* polynomial : {"num", "den"}) {
                std::string text;
                for (const double c : numbers_at(s.result.at("controller").at(part).at(polynomial)))
                    text += (text.empty() ? "" : ", ") + number_text(c, kTypedDigits);
                rows.push_back({std::string(part) + ", " + polynomial, text});
            }
        return table("The predictor; coefficients in descending powers of s", {"", ""}, rows);
    }
    if (structure != "feedforward") return {};
    std::vector<Row> rows;
    const JsonLocation variants = s.result.at("variants");
    for (std::size_t i = 0; i < variants.value().size(); ++i) {
        const JsonLocation compensator = variants.at(i).at("compensator");
        if (!compensator.exists()) continue;
        Row row{series_title(text_at(variants.at(i).at("kind")))};
        for (Html& cell : numbers(compensator, {"Kf", "Tz", "Tp", "Lf"})) row.push_back(std::move(cell));
        rows.push_back(std::move(row));
    }
    return table("Compensators Kf (Tz s + 1)/(Tp s + 1) e^(-Lf s)",
                 {"", "Kf", with_unit("Tz", s.time), with_unit("Tp", s.time), with_unit("Lf", s.time)}, rows);
}

/// The settings of the user's products.
Html typed_of(const ReportInput& s) {
    Html out;
    const JsonLocation settings = s.result.at("settings");
    for (std::size_t i = 0; i < settings.value().size(); ++i) {
        const JsonLocation typing = settings.at(i).at("typing");
        const std::string caption = text_at(settings.at(i).at("loop")) + ": " + text_at(typing.at("product"));
        std::vector<Row> rows;
        for (const auto& [name, value] : typing.at("settings").value().items())
            rows.push_back({name, figure(typing.at("settings").at(name), kTypedDigits)});
        out += rows.empty()
                   ? element("p", text_at(settings.at(i).at("loop")) + ": " + text_at(settings.at(i).at("why")))
                   : table(caption.c_str(), {"Setting", "Value"}, rows);
        std::vector<Html> notes;
        for (const Json& note : typing.at("notes").value()) notes.emplace_back(note.value("detail", ""));
        out += list(notes);
    }
    return out;
}

Html settings_of(const ReportInput& s, const std::string& structure) {
    std::vector<Row> rows;
    for (const StructureController& controller : structure_controllers(s.result.value())) {
        const JsonLocation pid = place_of(s, controller.pointer);
        if (!pid.exists()) continue;
        Row row{controller.name};
        for (const char* name : {"Kp", "Ti", "Td"}) row.push_back(figure(pid.at(name), kTypedDigits));
        row.push_back(pid.at("filter").at("Tf").exists() ? figure(pid.at("filter").at("Tf"), kTypedDigits) : Html("0"));
        rows.push_back(std::move(row));
    }
    Html out;
    if (!rows.empty())
        out += table("Controllers, ideal form",
                     {"", "Kp", with_unit("Ti", s.time), with_unit("Td", s.time), with_unit("Tf", s.time)}, rows);
    return section("Settings", out + other_settings(s, structure) + typed_of(s));
}

std::string unit_of(const StructureFigure& figure, const ReportInput& s) {
    if (figure.unit == "time") return s.time;
    if (figure.unit == "y") return s.y;
    if (figure.unit == "y time") return s.y.empty() ? s.time : s.y + " " + s.time;
    return figure.unit == "u/time" ? unit_quotient(s.u, s.time) : "";
}

Html figures_table(const ReportInput& s) {
    std::vector<Row> rows;
    for (const StructureFigure& one : structure_figures(s.result.value())) {
        const JsonLocation place = place_of(s, one.pointer);
        if (!s.result.value().contains(Json::json_pointer(one.pointer))) continue;
        const std::string why = place.exists() ? "" : why_null(place);
        // A title is not seen on paper.
        rows.push_back({with_unit(one.name, unit_of(one, s)), figure(place) + (why.empty() ? "" : " " + why)});
    }
    return section("Figures", table("", {"", ""}, rows));
}

/// One drawing for each signal after a step at each input.
Html responses_of(const ReportInput& s) {
    std::vector<std::pair<std::string, Plot>> plots;  // by input and signal
    const JsonLocation responses = s.result.at("responses");
    for (std::size_t i = 0; i < responses.value().size(); ++i) {
        const JsonLocation one = responses.at(i);
        const std::string input = text_at(one.at("input"));
        for (std::size_t k = 0; k < one.at("signals").value().size(); ++k) {
            const JsonLocation signal = one.at("signals").at(k);
            const std::string name = text_at(signal.at("name")), key = input + "/" + name;
            auto found = std::ranges::find(plots, key, &std::pair<std::string, Plot>::first);
            if (found == plots.end())
                found = plots.insert(plots.end(), {key,
                                                   {.title = input_title(input) + ": " + name,
                                                    .x_label = with_unit("t", s.time),
                                                    .y_label = name,
                                                    .traces = {}}});
            auto& traces = found->second.traces;
            traces.push_back({.name = series_title(text_at(one.at("of"))),
                              .line = kSeriesLines[traces.size() % kSeriesLines.size()],
                              .x = numbers_at(one.at("t")),
                              .y = numbers_at(signal.at("values"))});
        }
    }
    Html out;
    for (const auto& [key, plot] : plots) out += drawn(plot);
    if (out.empty()) return {};
    return section("Responses", element("div", out, {{"class", "figures"}}));
}

Html peaks_of(const ReportInput& s) {
    const JsonLocation all = s.result.at("sensitivities"), curves = all.at("curves");
    Plot plot{.title = "Sensitivity",
              .x_label = with_unit("Frequency", unit_quotient("rad", s.time)),
              .y_label = "|S|",
              .traces = {},
              .log_x = true};
    for (std::size_t i = 0; i < curves.value().size(); ++i) {
        const JsonLocation curve = curves.at(i);
        const std::string of = text_at(curve.at("of")), loop = text_at(curve.at("loop"));
        if (of != text_at(curves.at(0).at("of"))) continue;
        plot.traces.push_back({.name = loop_title(loop),
                               .line = kSeriesLines[plot.traces.size() % kSeriesLines.size()],
                               .x = numbers_at(all.at("omega")),
                               .y = numbers_at(curve.at("values"))});
        if (curve.at("limit").value().is_number())
            plot.limits.emplace_back("limit, " + loop_title(loop), curve.at("limit").value().get<double>());
    }
    const Html drawing = drawn(plot);
    return drawing.empty() ? Html() : section("Robustness", element("div", drawing, {{"class", "figures"}}));
}

}  // namespace

Html structure_sections(const ReportInput& subject) {
    const std::string structure = text_at(subject.result.at("structure"));
    return conclusions_of(subject) + settings_of(subject, structure) + figures_table(subject) + responses_of(subject) +
           peaks_of(subject);
}

}  // namespace tunewright::api
