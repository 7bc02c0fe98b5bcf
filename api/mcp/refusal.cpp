#include "api/mcp/refusal.h"

#include "api/describe/reader.h"
#include "api/json/utf8.h"

namespace tunewright::api::mcp {
namespace {

constexpr std::size_t kMaxFaults = 20;  // of one refusal
constexpr std::size_t kMaxText = 600;   // bytes of a place or a sentence: both repeat names as they were sent

/// Texts that are too long for a context are cut.
void shorten(Json& value) {
    if (value.is_string()) {
        const auto& text = value.get_ref<const std::string&>();
        if (text.size() > kMaxText) value = std::string(whole_characters(text, kMaxText)) + "...";
    }
    if (value.is_structured())
        for (Json& inner : value) shorten(inner);
}

std::string member(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

Json shown_problem(std::string_view problem) {
    Json value = Json::parse(problem, nullptr, false);
    if (!value.is_object()) return {{"detail", std::string(problem)}};
    value.erase("record");
    if (const auto errors = value.find("errors"); errors != value.end() && errors->size() > kMaxFaults) {
        const std::size_t more = errors->size() - kMaxFaults;
        errors->erase(errors->begin() + kMaxFaults, errors->end());
        value["more_errors"] = more;  // a new member moves the others
    }
    shorten(value);
    return value;
}

std::string refusal_text(const Json& problem, const Tool& tool) {
    const Json errors = problem.value("errors", Json::array());
    std::string out;
    for (const Json& error : errors) {
        const std::string place = member(error, "pointer");
        out += (place.empty() ? "" : place + ": ") + member(error, "detail") + "\n";
    }
    if (const auto more = problem.find("more_errors"); more != problem.end())
        out += "And " + more->dump() + " more faults.\n";
    if (errors.empty()) out = member(problem, "title") + ". " + member(problem, "detail") + "\n";
    if (const auto cure = problem.find("cure"); cure != problem.end() && cure->is_object())
        out += member(*cure, "text") + ".\n";
    if (!errors.empty()) out += std::string("A right call of ") + tool.name + ": " + tool.example + "\n";
    return out;
}

Refused not_an_object(const Json& arguments) {
    Reader reader;
    reader.fault("arguments is " + kind_of(arguments) +
                 "; it must be an object with the members of the tool, not their text.");
    return refused(*reader.problem());
}

}  // namespace tunewright::api::mcp
