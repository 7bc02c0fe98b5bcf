#include "api/shorthand.h"

#include <algorithm>
#include <iterator>

#include "api/contract/range/range_request.h"
#include "api/contract/request.h"
#include "api/csv/shape/shapes.h"
#include "api/csv/text.h"

namespace tunewright::api {
namespace {

constexpr const char* kBlank = " \t\r\n";

Problem unclear(std::string detail) {
    return {422, "invalid-request", "The request is not valid", std::move(detail), {}, {}};
}

/// The number that a word stands for; any other word stays a text, for the contract to refuse.
Json number_or_word(const std::string& word) {
    Json value = Json::parse(word, nullptr, false);
    return value.is_number() ? value : Json(word);
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t at = 0; (at = text.find_first_not_of(" ,;", at)) != text.npos;) {
        const std::size_t end = std::min(text.find_first_of(" ,;", at), text.size());
        words.emplace_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

/// Refuses options for reading a CSV file if the input is not one.
std::optional<Problem> without_csv(const CsvRequest& question) {
    const std::pair<const char*, bool> given[] = {
        {"--t", !question.t.empty()},           {"--u", !question.u.empty()},
        {"--y", !question.y.empty()},           {"--r", !question.r.empty()},
        {"--d", !question.d.empty()},           {"--dt", !question.dt.empty()},
        {"--kind", !question.kind.empty()},     {"--u0", !question.u0.empty()},
        {"--y0", !question.y0.empty()},         {"--run", !question.run.empty()},
        {"--u-step", !question.u_step.empty()}, {"--u-limits", !question.u_limits.empty()},
        {"--mode", !question.mode.empty()}};
    for (const auto& [name, is] : given)
        if (is)
            return unclear(std::string(name) +
                           " is an option for reading a CSV file, but the input is not one; a request as JSON has this "
                           "in its record. Leave it out.");
    return std::nullopt;
}

bool of_ultimate(const TuneWords& words) { return !words.Ku.empty() || !words.Pu.empty() || !words.K.empty(); }

std::variant<Json, Problem> subject(const TuneWords& words, const std::optional<std::string>& file) {
    if (!words.plant.empty() && file)
        return unclear("Both a plant and a file are given; the file already has a plant. Leave one of them out.");
    const auto request = file ? request_text(*file) : std::nullopt;
    if (auto problem = without_csv(words.record); problem && (!words.plant.empty() || of_ultimate(words) || request))
        return *problem;
    if (of_ultimate(words)) {
        if (file || !words.plant.empty())
            return unclear("--Ku and --Pu replace a plant or a file; give only one of these.");
        Json ultimate = Json::object();
        for (const auto& [name, word] : {std::pair{"Ku", &words.Ku}, {"Pu", &words.Pu}, {"K", &words.K}})
            if (!word->empty()) ultimate[name] = number_or_word(*word);
        return Json{{"ultimate", std::move(ultimate)}};
    }
    if (!words.plant.empty()) return Json{{"plant", words.plant}};
    if (!file) return unclear("There is nothing to tune: name a file, or give --plant \"2 e^(-3s)/(10s+1)\".");
    if (file->find_first_not_of(kBlank) == file->npos)
        return unclear("The body is empty; give a recorded test as CSV, or a request as JSON.");
    if (request) return parse(*request);
    std::string storage;
    return Json{{"record", record_of(words.record, std::string(utf8_text(*file, storage)))}};
}

void put_methods(const TuneWords& words, Json& request) {
    if (!words.methods.empty()) {
        request["tune"] = Json::array();
        for (const std::string& method : words.methods) request["tune"].push_back({{"method", method}});
    }
    if (words.Ms.empty()) return;
    if (!request.contains("tune")) request["tune"] = Json::array({{{"method", "robust"}}});
    const auto holds_limits = [](const Json& entry) {
        const Json method = entry.is_object() ? entry.value("method", Json()) : Json();
        return method == "robust" || method == "all";
    };
    Json& entries = request["tune"];
    const bool some = std::any_of(entries.begin(), entries.end(), holds_limits);
    for (Json& entry : entries) {
        if (!entry.is_object() || (some && !holds_limits(entry))) continue;
        entry["Ms"] = number_or_word(words.Ms);
        if (holds_limits(entry)) entry["Mt"] = entry["Ms"];
    }
}

bool is_index(const std::string& name) {
    return !name.empty() && name.size() <= 3 && name.find_first_not_of("0123456789") == name.npos;
}

/// The member of an object, or the element of a list, which is added if it is the next one; null if there is none.
Json* member_of(Json& whole, const std::string& name) {
    if (whole.is_null()) whole = is_index(name) ? Json::array() : Json::object();
    if (whole.is_object() && !name.empty()) return &whole[name];
    if (!whole.is_array() || !is_index(name)) return nullptr;
    const std::size_t index = std::stoul(name);
    return index <= whole.size() ? &whole[index] : nullptr;
}

/// Sets a member by its place, "evaluate.own_step.target=60": numbers between the dots count the elements of a list.
std::optional<Problem> put_member(const std::string& setting, Json& request) {
    const std::size_t equals = setting.find('=');
    const std::string quoted = "--set is \"" + setting + "\"";
    if (equals == setting.npos)
        return unclear(quoted + "; it must be MEMBER=VALUE, such as evaluate.own_step.target=60.");
    Json* at = &request;
    for (std::size_t from = 0; from <= equals;) {
        const std::size_t end = std::min(setting.find('.', from), equals);
        at = member_of(*at, setting.substr(from, end - from));
        if (at == nullptr)
            return unclear(quoted + "; the request has no place " + setting.substr(0, end) +
                           ". Name its members with dots between them, such as evaluate.own_step.target.");
        from = end + 1;
    }
    const std::string value = setting.substr(equals + 1);
    *at = Json::parse(value, nullptr, false);
    if (at->is_discarded()) *at = value;
    return std::nullopt;
}

/// True if the text is an object about a plant, a record, an ultimate point or a model, also in each of its `points`,
/// and if its arrays are members of a request: a record may have a member that names its plant.
bool holds_request(std::string_view text) {
    const auto parsed = parse(text);
    const Json* value = std::get_if<Json>(&parsed);
    if (value == nullptr || !value->is_object()) return false;
    const auto has_source = [](const Json& object) {
        return object.is_object() && std::ranges::any_of(request_sources(), [&](const std::string& source) {
                   return object.contains(source);
               });
    };
    for (const auto& [name, member] : value->items())
        if (member.is_array() && !is_request_member(name)) return false;
    if (has_source(*value)) return true;
    const auto points = value->find("points");
    return points != value->end() && points->is_array() && std::ranges::all_of(*points, has_source);
}

}  // namespace

Json record_of(const CsvRequest& question, std::string csv) {
    Json columns = Json::object();
    const auto column_of = [](const std::string& choice) {
        const bool number = choice.size() <= 3 && choice.find_first_not_of("0123456789") == std::string::npos;
        return number ? Json(std::stoi(choice)) : Json(choice);
    };
    for (const auto& [name, choice] : {std::pair{"t", &question.t},
                                       {"u", &question.u},
                                       {"y", &question.y},
                                       {"r", &question.r},
                                       {"mode", &question.mode}}) {
        if (choice->empty()) continue;
        columns[name] = column_of(*choice);
    }
    for (const std::string& choice : question.d) columns["d"].push_back(column_of(choice));
    Json record{{"csv", std::move(csv)}};
    if (!columns.empty()) record["columns"] = std::move(columns);
    if (!question.kind.empty()) record["kind"] = question.kind;
    if (!question.dt.empty()) record["dt"] = number_or_word(question.dt);
    if (!question.time_unit.empty()) record["time_unit"] = question.time_unit;
    for (const auto& [name, word] : {std::pair{"u0", &question.u0}, {"y0", &question.y0}, {"run", &question.run}})
        if (!word->empty()) record[name] = number_or_word(*word);
    for (const std::string& limit : question.u_limits) record["u_limits"].push_back(number_or_word(limit));
    for (const std::string& level : question.u_step) record["u_step"].push_back(number_or_word(level));
    return record;
}

std::string controller_record_request(const CsvRequest& question, const std::string& file) {
    std::string storage;
    Json request{{"record", record_of(question, std::string(utf8_text(file, storage)))}};
    if (!question.answer_unit.empty()) request["units"] = {{"time", question.answer_unit}};
    return request.dump();
}

std::optional<std::string> request_text(const std::string& file) {
    std::string storage;
    const std::string_view text = utf8_text(file, storage);
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == text.npos || text[first] != '{') return std::nullopt;
    // A record may also be one JSON object: of samples, or of columns.
    if (!holds_request(text) && json_rows(text)) return std::nullopt;
    const std::size_t end = text.find('\n', first);
    if (end == text.npos) return std::string(text);
    const std::size_t last = text.find_last_not_of(kBlank, end), next = text.find_first_not_of(kBlank, end);
    if (text[last] == '}' && next != text.npos && text[next] == '{') return std::nullopt;
    return std::string(text);
}

std::variant<std::string, Problem> tuning_request(const TuneWords& words, std::optional<std::string> file) {
    const bool as_csv = words.plant.empty() && file && !request_text(*file);
    auto found = subject(words, file);
    if (auto* problem = std::get_if<Problem>(&found)) return std::move(*problem);
    Json& request = std::get<Json>(found);
    put_methods(words, request);
    if (!words.record.model.empty()) {
        if (!request.contains("record"))
            return unclear("--model chooses the model of a recorded test, but no test is given. Leave it out.");
        if (request.value("identify", Json::object()).is_object()) request["identify"]["model"] = words.record.model;
    }
    // --time-unit is the file's if a record is read as text; otherwise it is that of the whole request.
    const std::string& unit = !words.record.answer_unit.empty() ? words.record.answer_unit
                              : as_csv                          ? std::string()
                                                                : words.record.time_unit;
    if (!unit.empty() && request.value("units", Json::object()).is_object()) request["units"]["time"] = unit;
    // "Kp Ti Td" has only numbers; anything with a bracket or an operator is a controller as text.
    if (words.baseline == "from-record" || words.baseline.find_first_of("(=/*") != words.baseline.npos) {
        request["baseline"] = words.baseline;
    } else if (!words.baseline.empty()) {
        Json& today = request["baseline"] = {{"form", "ideal"}};
        const std::vector<std::string> values = words_of(words.baseline);
        constexpr const char* kNames[] = {"Kp", "Ti", "Td"};
        if (values.size() > std::size(kNames))
            return unclear("--baseline is \"" + words.baseline +
                           "\"; it must be Kp, Ti and Td of the ideal form, such as \"0.5 10 0\".");
        for (std::size_t i = 0; i < values.size(); ++i) today[kNames[i]] = number_or_word(values[i]);
    }
    for (const std::string& setting : words.set)
        if (auto problem = put_member(setting, request)) return *std::move(problem);
    return request.dump();
}

}  // namespace tunewright::api
