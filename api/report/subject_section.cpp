// The controlled process: the plant, or the record with the model identified from it.
#include <algorithm>
#include <cmath>

#include "api/contract/plant/mathml.h"
#include "api/contract/plant/plant.h"
#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

/// The formula of a linear plant; empty for another.
Html formula(const Json& plant) {
    Reader reader;
    Plant read;
    plant_contract().read(plant, read, reader);
    if (reader.problem()) return {};
    return element("div", Html::trusted(mathml(read)), {{"class", "formula"}});
}

std::string plain(const Json& value) {
    return value.is_string()   ? value.get<std::string>()
           : value.is_number() ? number_text(value.get<double>(), 6)
                               : value.dump();
}

/// The uncertainty in words: "K 0.8 to 1.2, L 0.9 to 1.2 times the value".
Html uncertainty_of(const Json& plant) {
    if (!plant.is_object() || !plant.contains("uncertainty")) return {};
    std::string words;
    for (const auto& [name, range] : plant["uncertainty"].items())
        if (range.is_array() && range.size() == 2)
            words += (words.empty() ? "" : ", ") + name + " " + plain(range[0]) + " to " + plain(range[1]);
    return element("p", "Uncertain, as factors of the values: " + words + ".");
}

Html equations_of(const Json& plant) {
    std::vector<Html> lines;
    const auto each = [&](const char* member, const auto& write) {
        if (plant.contains(member) && plant[member].is_object())
            for (const auto& [name, value] : plant[member].items())
                lines.push_back(element("code", write(name, plain(value))));
    };
    each("equations", [](const std::string& name, const std::string& text) { return "d" + name + "/dt = " + text; });
    lines.push_back(element("code", "y = " + plain(plant.value("output", Json("")))));
    each("parameters", [](const std::string& name, const std::string& text) { return name + " = " + text; });
    if (plant.contains("input")) lines.push_back("Input: " + plant["input"].dump());
    if (plant.contains("L")) lines.push_back("Dead time: " + plain(plant["L"]));
    return element("p", "Differential equations:") + list(lines);
}

Html points_of(const Json& plant) {
    const Json& omega = plant["omega"];
    if (!omega.is_array() || omega.empty()) return {};
    return element("p", "Measured points of the frequency response: " + std::to_string(omega.size()) + ", from " +
                            plain(omega.front()) + " to " + plain(omega.back()) + " rad per unit of time.");
}

Html given_plant(const ReportInput& s) {
    const Json& plant = s.request.at("plant").value();
    if (!plant.is_object()) return {};
    const std::string type = plant.value("type", "");
    if (type == "nonlinear") {
        Html out = equations_of(plant);
        const JsonLocation point = s.result.at("operating_point");
        if (point.at("u").exists())
            out += element("p", Html("Operating point: u ") + figure(point.at("u"), 6) + ", y " +
                                    figure(point.at("y"), 6) + ". The linear model there:") +
                   formula(s.result.at("linear_model").value());
        return out;
    }
    if (type == "frequency_response") return points_of(plant);
    if (type != "set") return formula(plant) + uncertainty_of(plant);
    Html out = element("p", "Several plants, the first of which is nominal; limits hold on all of them:");
    for (const Json& one : plant["plants"]) out += formula(one) + uncertainty_of(one);
    return out;
}

Html parameters_of(const JsonLocation& model, const ReportInput& s) {
    std::vector<Row> rows;
    for (const auto& [name, value] : model.at("plant").value().items()) {
        if (!value.is_number()) continue;
        const bool time = name[0] == 'T' || name == "L";
        const JsonLocation error = model.at("standard_errors").at(name);
        const bool known = error.exists() && !negligible(error.value().get<double>(), value.get<double>());
        rows.push_back({with_unit(name, time          ? s.time
                                        : name == "K" ? unit_quotient(s.y, s.u)
                                                      : ""),
                        figure(model.at("plant").at(name)),
                        known            ? "± " + figure(error, 2)
                        : error.exists() ? Html("negligible")
                                         : Html("")});
    }
    if (rows.empty()) return {};
    return table("Identified parameters", {"", "Value", "Standard error"}, rows);
}

/// Figures of the record in words, in their order; others by their names.
constexpr std::pair<const char*, const char*> kQuality[] = {{"test", "Test"},
                                                            {"samples", "Samples"},
                                                            {"samples_dropped", "Rows left out"},
                                                            {"sample_time", "Time between samples"},
                                                            {"irregular", "Irregular times"},
                                                            {"noise_std", "Noise of y"},
                                                            {"quantisation", "Smallest step of y"},
                                                            {"steps", "Moves of u"},
                                                            {"cycles", "Periods of the relay"},
                                                            {"settled", "y came to rest"},
                                                            {"u0", "u at the start"},
                                                            {"y0", "y at the start"},
                                                            {"repeated_times", "Repeated times"},
                                                            {"backward_times", "Times out of order"}};

std::string quality_label(const std::string& name) {
    for (const auto& [member, label] : kQuality)
        if (name == member) return label;
    std::string label = name;
    std::ranges::replace(label, '_', ' ');
    return label;
}

Html quality_of(const JsonLocation& quality) {
    std::vector<Row> rows;
    for (const auto& [name, value] : quality.value().items()) {
        if (name == "kind") continue;
        const std::string label = quality_label(name);
        if (value.is_number()) rows.push_back({label, figure(quality.at(name))});
        if (value.is_boolean()) rows.push_back({label, value.get<bool>() ? "yes" : "no"});
        if (value.is_string()) rows.push_back({label, value.get<std::string>()});
    }
    std::vector<Html> notes;
    for (const Json& note : quality.at("notes").value())
        if (note.is_string()) notes.push_back(note.get<std::string>());
    return table("The record", {"", ""}, rows) + list(notes);
}

Html fit_of(const JsonLocation& fit, const ReportInput& s) {
    if (!fit.at("t").exists() || !fit.at("y_model").exists()) return {};
    const std::vector<double> t = numbers_at(fit.at("t"));
    Plot plot{
        .title = "Record and model", .x_label = with_unit("t", s.time), .y_label = with_unit("y", s.y), .traces = {}};
    plot.traces.push_back({.name = "Record", .line = Line::setpoint, .x = t, .y = numbers_at(fit.at("y"))});
    plot.traces.push_back({.name = "Model", .line = Line::proposal, .x = t, .y = numbers_at(fit.at("y_model"))});
    Plot input{.title = "Record: u", .x_label = with_unit("t", s.time), .y_label = with_unit("u", s.u), .traces = {}};
    input.traces.push_back({.name = "", .line = Line::setpoint, .x = t, .y = numbers_at(fit.at("u"))});
    return element("div", drawn(plot) + drawn(input), {{"class", "figures"}});
}

Html identified(const ReportInput& s) {
    const JsonLocation model = s.result.at("model");
    if (!model.at("plant").exists()) return {};
    Html out = element("p", "Identified from a recorded test:") + formula(model.at("plant").value());
    out += element("p", element("strong", grade_words(text_at(model.at("grade")), text_at(model.at("grade_reason")))) +
                            " Fit of the free run " + figure(model.at("fit_percent")) + " %. " +
                            text_at(model.at("choice_reason")));
    out += fit_of(model.at("fit"), s);
    out += element("div", parameters_of(model, s) + element("div", quality_of(model.at("data_quality"))),
                   {{"class", "tables"}});
    const JsonLocation band = model.at("excited_band");
    if (band.at("omega_low").exists())
        out += element("p", Html("The record excites from ") + figure(band.at("omega_low")) + " to " +
                                figure(band.at("omega_high")) + " rad/" + s.time + ".");
    std::vector<Html> warnings;
    for (std::size_t i = 0; i < model.at("warnings").value().size(); ++i)
        warnings.push_back(text_at(model.at("warnings").at(i).at("detail")));
    return out + list(warnings);
}

}  // namespace

Html plant_section(const ReportInput& s) {
    const Html record = identified(s);
    if (!record.empty()) return section("Record and model", record);
    return section("Plant", given_plant(s));
}

Html assumptions_section(const ReportInput& s) {
    const JsonLocation evaluate = s.request.at("evaluate");
    const auto step = [&](const char* name, const std::string& unit) {
        const Json& value = evaluate.at(name).value();
        return (value.is_number() ? number_text(value.get<double>(), 6) : std::string("1")) +
               (unit.empty() ? "" : " " + unit);
    };
    const bool nonlinear = s.result.at("operating_point").exists();
    std::vector<Html> out = {
        nonlinear
            ? "Methods and margins use the linear model at the operating point; responses are those of the equations."
            : "The plant is linear about its operating point, with the dead time at its input; all values are "
              "deviations from that point.",
        "Responses: a set-point step of " + step("setpoint_step", s.y) + " and a load step of " +
            step("load_step", s.u) + " at the plant's input, both at t = 0. Indices are integrals " +
            (evaluate.at("horizon").value().is_number()
                 ? "to " + number_text(evaluate.at("horizon").value().get<double>(), 6) + " " + s.time + "."
                 : "until the response has settled."),
        "u = Kp [b r − y + (1/Ti) ∫(r − y) dt + Td d/dt (c r − y)], y filtered as the table says. L = P C, S = 1/(1 + "
        "L), "
        "T = L/(1 + L); Ms and Mt are their largest absolute values.",
        "A model is never the process: watch the loop when you enter the settings, and keep today's settings ready."};
    const JsonLocation check = s.entry.at("verification");
    if (check.at("iae_step_halving").exists())
        out.push_back(Html("Check: halving every time step changes the load IAE by ") +
                      figure(check.at("iae_step_halving"), 2) + " relative; stability by two methods that " +
                      (check.at("stability_methods_agree").value() == true ? "agree." : "do not agree."));
    const JsonLocation longest = s.entry.at("longest_sample_time");
    if (longest.value().is_number())
        out.push_back(Html("The controller must run at least every ") + figure(longest) + " " + s.time +
                      " to keep Ms within 5 %.");
    return section("Assumptions and limits", list(out));
}

}  // namespace tunewright::api
