#include "api/mcp/short_answer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "api/contract/structure/structure_name.h"
#include "api/report/check_words.h"
#include "api/report/terminal/entry_rows.h"
#include "api/report/terminal/terminal.h"
#include "engine/number_text.h"

namespace tunewright::api::mcp {
namespace {

constexpr int kShortDigits = 5;
constexpr std::size_t kMaxRows = 12;  // controllers of a table, loops of a check, candidates of a record

/// A member of a short answer and its place in the whole one; members that are null there are left out.
struct Pick {
    const char* name;
    const char* pointer;
};

constexpr Pick kBest[] = {
    {"controller", "/controller"},
    {"product", "/as_entered/product"},
    {"settings", "/as_entered/as_typed"},
    {"units_of_settings", "/as_entered/units"},
    {"notes", "/as_entered/notes"},
    {"stable", "/robustness/stable"},
    {"gain_margin", "/robustness/gain_margin"},
    {"phase_margin_deg", "/robustness/phase_margin_deg"},
    {"delay_margin", "/robustness/delay_margin"},
    {"Mks", "/robustness/Mks"},
    {"overshoot_percent", "/performance/setpoint/overshoot_percent"},
    {"settling_time", "/performance/setpoint/settling_time"},
    {"load_peak", "/performance/load/peak"},
    {"recovery_time", "/performance/load/recovery_time"},
    {"longest_sample_time", "/longest_sample_time"},
    {"proved_lower_bound", "/certificate/lower"},
    {"proved_gap", "/certificate/gap"},
    {"warnings", "/warnings"},
};
constexpr Pick kModel[] = {{"plant", "/plant"},
                           {"fit_percent", "/fit_percent"},
                           {"grade", "/grade"},
                           {"grade_reason", "/grade_reason"},
                           {"standard_errors", "/standard_errors"},
                           {"warnings", "/warnings"}};
constexpr Pick kCandidate[] = {{"plant", "/plant"}, {"fit_percent", "/fit_percent"}};
constexpr Pick kLoop[] = {{"tag", "/tag"},
                          {"cause", "/cause/verdict"},
                          {"confidence", "/cause/confidence"},
                          {"why_open", "/cause/why_open"},
                          {"evidence", "/cause/evidence"},
                          {"action", "/action"},
                          {"period", "/oscillation/period"},
                          {"remarks", "/quality/remarks"},
                          {"cure", "/cure/detail"}};
constexpr Pick kRelay[] = {
    {"plan", "/plan"}, {"limit_cycle", "/limit_cycle"}, {"reversed", "/reversed"}, {"warnings", "/warnings"}};
constexpr Pick kSettings[] = {{"product", "/product"},   {"settings", "/as_typed"}, {"units_of_settings", "/units"},
                              {"realised", "/realised"}, {"notes", "/notes"},       {"snippets", "/snippets"}};
constexpr Pick kController[] = {{"controller", "/controller"}, {"notes", "/notes"}};
constexpr Pick kJob[] = {{"id", "/id"}, {"name", "/name"}, {"status", "/status"}, {"outline", "/outline"}};

Json picked(const Json& source, std::span<const Pick> picks) {
    Json out = Json::object();
    for (const Pick& pick : picks)
        if (Json value = member_at(source, pick.pointer); !value.is_null()) out[pick.name] = rounded(value);
    return out;
}

std::string text_of(const Json& value) {
    if (value.is_number()) return tunewright::text(value.get<double>());
    return value.is_string() ? value.get<std::string>() : value.dump();
}

/// The findings without their figures, which are among those of the entry.
Json findings(const Json& verdict) {
    Json out = Json::array();
    for (const Json& finding : verdict)
        out.push_back({{"code", finding.at("code")}, {"level", finding.at("level")}, {"text", finding.at("text")}});
    return out;
}

Json row_json(const EntryRow& row) {
    Json out{{"index", row.index}, {"method", row.method}, {"title", row.title}};
    for (std::size_t i = 0; i < kEntryFigures.size(); ++i) {
        std::string name = kEntryFigures[i].name;
        std::ranges::replace(name, ' ', '_');
        out[name] = rounded(row.figures[i]);
    }
    out["verdict"] = row.level;
    return out;
}

/// The findings about the result as a whole that the best entry's verdict does not have.
Json conclusions(const Json& result, const Json& best) {
    const Json of_best = best.value("verdict", Json::array());
    Json out = Json::array();
    for (const Json& finding : findings(result.value("verdict", Json::array())))
        if (std::ranges::none_of(of_best, [&](const Json& one) { return one.at("code") == finding["code"]; }))
            out.push_back(finding);
    return out;
}

ToolAnswer short_tuning(const Json& result, std::string_view text) {
    const EntryRows found = entry_rows(result);
    const Json& best = result.at("controllers").at(entry_order(result).front());
    Json figures = Json::object();
    if (result.contains("units")) figures["units"] = result["units"];
    if (result.contains("model")) figures["model"] = picked(result["model"], kModel);
    figures["conclusions"] = conclusions(result, best);
    for (std::size_t i = 0; i < std::min(kMaxRows, found.rows.size()); ++i)
        figures["controllers"].push_back(row_json(found.rows[i]));
    figures["best"] = picked(best, kBest);
    figures["best"]["verdict"] = findings(best.value("verdict", Json::array()));

    std::string out;
    for (const Json& finding : figures["conclusions"]) out += text_of(finding["text"]) + "\n";
    if (!out.empty()) out += "\n";
    out += shortened_result_text(text, kMaxRows);
    if (best.contains("controller")) out += "Controller: " + one_line(figures["best"]["controller"]) + ".\n";
    return {std::move(out), std::move(figures)};
}

ToolAnswer short_check(const Json& answer, std::string_view text) {
    Json figures = Json::object();
    const std::vector<std::size_t> order = work_order(answer);
    for (std::size_t i = 0; i < std::min(kMaxRows, order.size()); ++i)
        figures["loops"].push_back(picked(answer.at("loops").at(order[i]), kLoop));
    return {check_text(text), std::move(figures)};
}

}  // namespace

Json rounded(const Json& value) {
    if (value.is_number_float())
        return std::strtod(tunewright::text(value.get<double>(), kShortDigits).c_str(), nullptr);
    if (!value.is_structured()) return value;
    Json out = value;
    for (Json& member : out) member = rounded(member);
    return out;
}

std::string one_line(const Json& object) {
    std::string out;
    const Json flat = object.flatten();
    for (const auto& [name, value] : flat.items()) {
        std::string path = name.substr(1);
        std::ranges::replace(path, '/', '.');
        out += (out.empty() ? "" : ", ") + path + " " + text_of(value);
    }
    return out;
}

ToolAnswer short_result(std::string_view result) {
    const Json value = Json::parse(result);
    if (is_of_check(value)) return short_check(value, result);
    if (!structure_of(value).empty()) return {structure_text(result), nullptr};
    if (value.contains("range")) return {range_text(result), nullptr};
    return short_tuning(value, result);
}

ToolAnswer short_model(std::string_view answer) {
    const Json value = Json::parse(answer);
    const Json& model = value.at("model");
    Json figures{{"model", picked(model, kModel)}};
    figures["model"]["choice_reason"] = model.value("choice_reason", Json());
    const Json candidates = model.value("candidates", Json::array());
    for (std::size_t i = 0; i < std::min(kMaxRows, candidates.size()); ++i)
        figures["candidates"].push_back(picked(candidates[i], kCandidate));
    figures["readings"] = member_at(model, "/data_quality/notes");
    std::string text = model_text(answer);
    for (const Json& note : figures["readings"]) text += text_of(note) + "\n";
    return {std::move(text), std::move(figures)};
}

ToolAnswer short_relay(std::string_view answer) {
    const Json figures = picked(Json::parse(answer), kRelay);
    std::string text;
    for (const char* part : {"plan", "limit_cycle"})
        if (figures.contains(part)) text += std::string(part) + ": " + one_line(figures[part]) + "\n";
    for (const Json& warning : figures.value("warnings", Json::array()))
        text += text_of(warning.value("message", Json(""))) + "\n";
    return {std::move(text), figures};
}

ToolAnswer short_settings(std::string_view answer) {
    const Json figures = picked(Json::parse(answer), kSettings);
    std::string text = settings_text(answer);
    for (const Json& snippet : figures.value("snippets", Json::array()))
        text += text_of(snippet.at("name")) + ":\n" + text_of(snippet.at("text")) + "\n";
    return {std::move(text), figures};
}

ToolAnswer short_controller(std::string_view answer) {
    const Json figures = picked(Json::parse(answer), kController);
    std::string text = "Controller: " + one_line(figures.at("controller")) + ".\n";
    for (const Json& note : figures.value("notes", Json::array())) text += text_of(note.at("detail")) + "\n";
    return {std::move(text), figures};
}

ToolAnswer short_jobs(std::string_view list) {
    Json figures{{"jobs", Json::array()}};
    std::string text;
    const Json value = Json::parse(list);
    for (const Json& job : value.at("jobs")) {
        figures["jobs"].push_back(picked(job, kJob));
        text += one_line(figures["jobs"].back()) + "\n";
    }
    return {text.empty() ? "There are no jobs.\n" : text, std::move(figures)};
}

ToolAnswer short_products(const Json& products) {
    std::string text;
    for (const Json& product : products)
        text +=
            text_of(product.at("id")) + ": " + text_of(product.at("maker")) + " " + text_of(product.at("name")) + "\n";
    return {text.empty() ? "No product has that in its id, maker or name. Search for less, or for nothing.\n" : text,
            {{"products", products}}};
}

}  // namespace tunewright::api::mcp
