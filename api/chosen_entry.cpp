#include "api/chosen_entry.h"

#include <charconv>
#include <utility>

#include "api/csv/text.h"

namespace tunewright::api {
namespace {

Problem not_found(std::string sentence) { return {404, "not-found", "Not Found", std::move(sentence), {}, {}}; }

std::string count_of(const Json& controllers) {
    if (controllers.size() == 1) return "the result has only number 0.";
    return "the result has " + std::to_string(controllers.size()) + ", numbers 0 to " +
           std::to_string(controllers.size() - 1) + ".";
}

// The best controller if none is named.
std::variant<std::size_t, Problem> index_of(const Json& result, std::string_view index) {
    const Json& controllers = result.at("controllers");
    std::size_t number = 0;
    if (index.empty()) {
        const Json ranking = result.value("ranking", Json::array());
        if (!ranking.empty() && ranking.front().is_number_unsigned()) number = ranking.front().get<std::size_t>();
    } else {
        const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), number);
        if (error != std::errc() || end != index.data() + index.size()) number = controllers.size();
    }
    if (number < controllers.size()) return number;
    std::string storage;
    return not_found("There is no controller " + std::string(utf8_text(index.substr(0, 20), storage)) + "; " +
                     count_of(controllers));
}

}  // namespace

std::optional<Problem> read_result(const ResultSource& source, ChosenEntry& found) {
    for (const auto& [text, value] :
         {std::pair{source.result, &found.result}, std::pair{source.request, &found.request}}) {
        if (value == &found.request && text.empty()) continue;
        auto parsed = parse(text);
        if (auto* problem = std::get_if<Problem>(&parsed)) return std::move(*problem);
        *value = std::move(std::get<Json>(parsed));
    }
    if (found.result.is_object() && found.result.contains("result")) {
        if (found.request.is_null()) found.request = found.result.value("request", Json());
        for (const auto& [member, target] :
             {std::pair{"id", &found.job}, {"name", &found.name}, {"finished_at", &found.date}})
            if (const auto at = found.result.find(member); at != found.result.end() && at->is_string())
                *target = at->get<std::string>();
        found.result = Json(found.result["result"]);
    }
    return std::nullopt;
}

std::optional<Problem> find_entry(std::string_view index, ChosenEntry& found) {
    const bool holds = found.result.is_object() && found.result.contains("controllers") &&
                       found.result["controllers"].is_array() && !found.result["controllers"].empty();
    if (!holds) return not_a_result();
    const auto number = index_of(found.result, index);
    if (const auto* problem = std::get_if<Problem>(&number)) return *problem;
    found.index = std::get<std::size_t>(number);
    const Json& entry = found.entry();
    if (entry.is_object() && entry.contains("controller")) return std::nullopt;
    const std::string method = entry.is_object() ? entry.value("method", "") : "";
    const Json::json_pointer detail("/error/detail");
    return not_found("Number " + std::to_string(found.index) + (method.empty() ? "" : " (" + method + ")") +
                     " has no controller: " +
                     (entry.contains(detail) ? entry.at(detail).get<std::string>() : "the method found none."));
}

bool has_schedule(const Json& result) {
    const Json::json_pointer rows("/range/schedule/rows");
    return result.is_object() && result.contains(rows) && result.at(rows).is_array() && !result.at(rows).empty();
}

Problem not_a_result() {
    return not_found("This is not a result with controllers. Give the answer of `tune` or of a succeeded job.");
}

std::variant<ChosenEntry, Problem> choose_entry(const ResultSource& source, std::string_view index) {
    ChosenEntry found;
    if (auto problem = read_result(source, found)) return *std::move(problem);
    if (auto problem = find_entry(index, found)) return *std::move(problem);
    return found;
}

}  // namespace tunewright::api
