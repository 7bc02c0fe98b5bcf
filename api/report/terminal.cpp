#include "api/report/terminal.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/json/json.h"
#include "api/report/columns.h"
#include "api/report/figures.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr const char* kNothing = "-";
constexpr std::size_t kWidestTitle = 44;

/// The member at a path such as "/performance/load/IAE"; null where there is none.
Json at(const Json& value, const char* pointer) {
    const Json::json_pointer where(pointer);
    return value.contains(where) ? value.at(where) : Json();
}

std::string number(const Json& value) { return value.is_number() ? tunewright::text(value.get<double>()) : kNothing; }
std::string words(const Json& value) { return value.is_string() ? value.get<std::string>() : ""; }

Json parsed_or_null(std::string_view text) {
    Json value = Json::parse(text, nullptr, false);
    return value.is_discarded() ? Json() : value;
}

std::string sentences(const Json& list, const char* member) {
    std::string out;
    for (const Json& item : list) {
        const std::string sentence = item.is_object() ? words(item.value(member, Json())) : words(item);
        if (!sentence.empty()) out += "  " + sentence + "\n";
    }
    return out;
}

/// "5.93 0.695"
std::string coefficients(const Json& values) {
    std::string out;
    for (const Json& value : values) out += (out.empty() ? "" : " ") + number(value);
    return out;
}

/// "K 0.6954 +- 0.0086, T1 141.4 +- 5.9", with the standard errors behind the signs; "num [5.93 0.695], den [..]".
std::string parameters(const Json& model) {
    const Json errors = model.value("standard_errors", Json::object());
    const Json plant = model.value("plant", Json::object());
    std::string out;
    for (const auto& [name, value] : plant.items()) {
        if (!value.is_number() && !value.is_array()) continue;
        const bool uncertain = errors.is_object() && errors.contains(name) && errors[name].is_number();
        out += (out.empty() ? "" : ", ") + name + " ";
        if (value.is_array())
            out += "[" + coefficients(value) + "]";
        else
            out += uncertain ? uncertain_text(value.get<double>(), errors[name].get<double>()) : number(value);
    }
    return out;
}

std::string model_lines(const Json& model) {
    std::string out =
        "Model " + words(at(model, "/plant/type")) + ", fit " + number(model.value("fit_percent", Json())) + " %";
    const std::string values = parameters(model);
    if (!values.empty()) out += ": " + values;
    const std::string grade =
        grade_words(words(model.value("grade", Json())), words(model.value("grade_reason", Json())));
    return out + "\n" + (grade.empty() ? "" : "  " + grade + "\n") +
           sentences(model.value("warnings", Json::array()), "message");
}

std::vector<std::size_t> order_of(const Json& result) {
    const std::size_t count = result.at("controllers").size();
    std::vector<std::size_t> order;
    for (const Json& place : result.value("ranking", Json::array()))
        if (place.is_number_unsigned() && place.get<std::size_t>() < count) order.push_back(place.get<std::size_t>());
    for (std::size_t i = 0; i < count; ++i)
        if (std::find(order.begin(), order.end(), i) == order.end()) order.push_back(i);
    return order;
}

std::string title_of(const Json& entry) {
    std::string title = words(entry.value("title", Json()));
    if (title.empty()) title = words(entry.value("method", Json()));
    if (letters(title) > kWidestTitle) title = std::string(whole_characters(title, kWidestTitle - 3)) + "...";
    return title;
}

std::string level_of(const Json& entry) {
    const Json first = at(entry, "/verdict/0/level");
    return first.is_string() ? first.get<std::string>() : kNothing;
}

std::string table_of(const Json& result, const std::string& time, std::size_t& refused) {
    const auto timed = [&](const char* name) { return std::string(name) + " (" + time + ")"; };
    Columns columns({"method", "controller", "Kp", timed("Ti"), timed("Td"), "Ms", "Mt", "load IAE", "verdict"}, 2);
    for (const std::size_t place : order_of(result)) {
        const Json& entry = result.at("controllers").at(place);
        if (!entry.contains("controller")) {
            ++refused;
            continue;
        }
        const Json Ti = at(entry, "/controller/Ti");
        columns.row({words(entry.value("method", Json())), title_of(entry), number(at(entry, "/controller/Kp")),
                     number(Ti), number(at(entry, "/controller/Td")), number(at(entry, "/robustness/Ms")),
                     number(at(entry, "/robustness/Mt")), number(at(entry, "/performance/load/IAE")), level_of(entry)});
    }
    return columns.text();
}

std::string text_of_result(const Json& result, const std::string& time) {
    std::string out;
    if (result.contains("model")) out += model_lines(result.at("model")) + "\n";
    std::size_t refused = 0;
    out += table_of(result, time, refused);
    if (refused > 0)
        out += std::to_string(refused) + (refused == 1 ? " method has" : " methods have") +
               " no answer on this plant; the JSON (--pretty) says why.\n";
    const std::vector<std::size_t> order = order_of(result);
    if (order.empty()) return out;
    const Json& best = result.at("controllers").at(order[0]);
    out += "\n" + title_of(best) + ":\n" + sentences(best.value("verdict", Json::array()), "text");
    return out + sentences(best.value("warnings", Json::array()), "message");
}

std::string listing(std::string_view answer, const char* member,
                    std::vector<std::pair<const char*, const char*>> heads) {
    const Json value = parsed_or_null(answer);
    std::vector<std::string> names;
    for (const auto& [head, name] : heads) names.emplace_back(head);
    Columns columns(names, heads.size());
    for (const Json& item : value.value(member, Json::array())) {
        std::vector<std::string> cells;
        for (const auto& [head, name] : heads) cells.push_back(words(item.value(name, Json())));
        columns.row(std::move(cells));
    }
    return columns.text();
}

}  // namespace

std::string result_text(std::string_view result) try {
    const Json value = parsed_or_null(result);
    if (value.contains("range")) return range_text(result);
    const std::string time = words(at(value, "/units/time"));
    return text_of_result(value, time.empty() ? "s" : time);
} catch (const Json::exception&) {
    return std::string(result) + "\n";
}

std::string model_text(std::string_view answer) try {
    const Json value = parsed_or_null(answer);
    const Json& model = value.at("model");
    std::string out = model_lines(model);
    const std::string reason = words(model.value("choice_reason", Json()));
    if (!reason.empty()) out += "  " + reason + "\n";
    Columns columns({"candidate", "fit (%)", "parameters"}, 3);
    for (const Json& candidate : model.value("candidates", Json::array()))
        columns.row({words(at(candidate, "/plant/type")), number(candidate.value("fit_percent", Json())),
                     parameters(candidate)});
    return out + "\n" + columns.text();
} catch (const Json::exception&) {
    return std::string(answer) + "\n";
}

std::string methods_text(std::string_view answer) {
    return listing(answer, "methods", {{"id", "id"}, {"method", "title"}});
}

std::string controllers_text(std::string_view answer) {
    return listing(answer, "controllers", {{"id", "id"}, {"maker", "maker"}, {"controller", "name"}, {"form", "form"}});
}

std::string examples_text(std::string_view answer) {
    Json all = parsed_or_null(answer);
    for (const Json& range : all.value("ranges", Json::array())) all["examples"].push_back(range);
    return listing(all.dump(), "examples", {{"id", "id"}, {"example", "title"}});
}

std::string problem_of_file(std::string_view problem, const std::string& file) {
    Json value = Json::parse(problem, nullptr, false);
    if (file.empty() || !value.is_object()) return std::string(problem);
    constexpr std::string_view kBody = "The body";
    for (const char* member : {"title", "detail"}) {
        const std::string sentence = words(value.value(member, Json()));
        if (sentence.starts_with(kBody)) value[member] = file + sentence.substr(kBody.size());
    }
    return value.dump();
}

std::string problem_text(std::string_view problem) {
    const Json value = parsed_or_null(problem);
    if (!value.is_object()) return std::string(problem) + "\n";
    std::string out = "tunewright: " + words(value.value("detail", value.value("title", Json()))) + "\n";
    const Json errors = value.value("errors", Json::array());
    if (errors.size() < 2) return out;
    for (const Json& fault : errors) {
        const std::string place = words(fault.value("pointer", Json()));
        out += "  " + (place.empty() ? "" : place + ": ") + words(fault.value("detail", Json())) + "\n";
    }
    return out;
}

}  // namespace tunewright::api
