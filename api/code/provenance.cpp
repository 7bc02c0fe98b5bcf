
#include "api/code/provenance.h"

#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxNumbers = 8;  // numbers of a list that are shown

std::string word_at(const Json& value, const char* place) {
    const Json::json_pointer pointer(place);
    if (!value.contains(pointer) || !value.at(pointer).is_string()) return {};
    return value.at(pointer).get<std::string>();
}

// The figure as text, "1.4", or the reason why there is none.
std::string figure_at(const Json& entry, const char* group, const char* name) {
    const Json::json_pointer pointer(std::string(group) + "/" + name);
    if (entry.contains(pointer) && entry.at(pointer).is_number())
        return tunewright::text(entry.at(pointer).get<double>(), 5);
    const std::string why = word_at(entry, (std::string(group) + "/why_null/" + name).c_str());
    return why.empty() ? "not known" : why;
}

std::string value_text(const Json& value) {
    if (value.is_number()) return tunewright::text(value.get<double>(), 6);
    if (value.is_string()) return value.get<std::string>();
    if (!value.is_array() || value.size() > kMaxNumbers) return "...";
    std::string list;
    for (const Json& element : value) list += (list.empty() ? "" : ", ") + value_text(element);
    return "[" + list + "]";
}

// The plant as text, "fopdt, K 2, T 10, L 3"; equations and long lists are left out.
std::string plant_text(const Json& plant) {
    std::string out = plant.value("type", "");
    for (const auto& [name, value] : plant.items()) {
        if (name != "type" && !value.is_object()) out += ", " + name + " " + value_text(value);
    }
    return out;
}

void add_plant(const Json& result, const Json& request, code::Provenance& rows) {
    if (result.contains("/model/plant"_json_pointer)) {
        rows.emplace_back("Plant", plant_text(result["model"]["plant"]) + " (identified from a record)");
    } else if (request.is_object() && request.contains("plant") && request["plant"].is_object()) {
        rows.emplace_back("Plant", plant_text(request["plant"]));
    } else if (result.contains("linear_model")) {
        rows.emplace_back("Plant", plant_text(result["linear_model"]) + " (linearised)");
    }
}

void add_units(const Json& result, code::Provenance& rows) {
    std::string units;
    for (const char* name : {"u", "y", "time"}) {
        const std::string unit = word_at(result, (std::string("/units/") + name).c_str());
        if (unit.empty()) continue;
        units += (units.empty() ? "" : ", ") + std::string(name) + " in " + unit;
    }
    if (!units.empty()) rows.emplace_back("Units", units + " in the request; all times here are in seconds");
}

void add_origin(const Json& result, code::Provenance& rows) {
    add_units(result, rows);
    if (result.value("partial", false))
        rows.emplace_back("Warning", "the search was stopped; this is the best found so far");
    const std::string hash = word_at(result, "/request_hash"), version = word_at(result, "/version");
    if (!hash.empty()) rows.emplace_back("Request", "SHA-256 " + hash);
    if (!version.empty()) rows.emplace_back("Tuned by", "Tunewright " + version);
}

}  // namespace

code::Provenance provenance_of(const Json& result, const Json& entry, const Json& request) {
    code::Provenance rows;
    const std::string name = word_at(request, "/name"), method = word_at(entry, "/method");
    if (!name.empty()) rows.emplace_back("Loop", name);
    add_plant(result, request, rows);
    const std::string title = word_at(entry, "/title");
    if (!method.empty()) rows.emplace_back("Method", title.empty() ? method : title + " (" + method + ")");
    if (entry.contains("robustness")) {
        rows.emplace_back("Ms", figure_at(entry, "/robustness", "Ms"));
        rows.emplace_back("Mt", figure_at(entry, "/robustness", "Mt"));
        if (!entry.at("robustness").value("stable", true))
            rows.emplace_back("Warning", "the loop with this controller is not stable");
    }
    if (entry.contains("/implemented/robustness/Ms"_json_pointer))
        rows.emplace_back("Ms, implemented", figure_at(entry, "/implemented/robustness", "Ms") +
                                                 ", with the sample time and the rules of the request's implement");
    if (entry.contains("/performance/load"_json_pointer))
        rows.emplace_back("Load IAE", figure_at(entry, "/performance/load", "IAE") + ", in the request's units");
    add_origin(result, rows);
    return rows;
}

code::Provenance provenance_of_schedule(const Json& result, const Json& request) {
    code::Provenance rows;
    const std::string name = word_at(request, "/name"), unit = word_at(result, "/range/scheduling/unit");
    if (!name.empty()) rows.emplace_back("Loop", name);
    const Json& range = result.at("range");
    const Json& scheduling = range.at("scheduling");
    rows.emplace_back("Range", word_at(scheduling, "/name") + " from " + value_text(scheduling.at("from")) + " to " +
                                   value_text(scheduling.at("to")) + (unit.empty() ? "" : " " + unit));
    for (const Json& worst : range.value("/worst/schedule"_json_pointer, Json::array()))
        rows.emplace_back(
            "Largest " + (word_at(worst, "/quantity") == "relative_IAE" ? "IAE relative to the place's own optimum"
                                                                        : word_at(worst, "/quantity")),
            value_text(worst.at("value")) + " at " + value_text(worst.at("at")));
    add_origin(result, rows);
    return rows;
}

namespace {

ControllerCode file_of(const code::Program& program, code::Language language, std::string text) {
    switch (language) {
        case code::Language::structured_text: return {"text/plain", code::type_name(program) + ".st", std::move(text)};
        case code::Language::c: return {"text/x-c", "tunewright_" + program.name + ".h", std::move(text)};
        case code::Language::python: return {"text/x-python", "tunewright_" + program.name + ".py", std::move(text)};
        case code::Language::arduino: return {"text/x-arduino", "tunewright_" + program.name + ".ino", std::move(text)};
    }
    return {};
}

}  // namespace

ControllerCode printed(const code::Program& program, code::Language language, const code::Provenance& provenance,
                       const SampleTime& sample_time) {
    code::Provenance rows = provenance;
    rows.emplace_back("Sample time", tunewright::text(sample_time.seconds, 6) + " s, " + sample_time.origin);
    return file_of(program, language, code::print(program, language, rows));
}

}  // namespace tunewright::api
