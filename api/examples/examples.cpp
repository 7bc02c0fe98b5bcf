#include "api/examples/examples.h"

#include <vector>

#include "api/contract/range/range_request.h"
#include "api/describe/suggest.h"
#include "api/embed/files.h"
#include "api/json/json.h"

namespace tunewright::api {
namespace {

bool is_example(std::string_view name) {
    constexpr std::string_view kFolder = "examples/", kEnd = ".json";
    return name.substr(0, kFolder.size()) == kFolder && name.size() > kEnd.size() &&
           name.substr(name.size() - kEnd.size()) == kEnd;
}

// Replaces the name of a file in a record's csv by the text of that file.
void insert_record(Json& request) {
    if (!request.contains("record")) return;
    Json& csv = request["record"]["csv"];
    csv = std::string(embedded_file("examples/" + csv.get<std::string>()));
}

/// The examples about one loop, or those about a range: a client that shows one kind does not need the other.
Json examples_of(bool ranges) {
    Json examples = Json::array();
    for (const EmbeddedFile& file : embedded_files()) {
        if (!is_example(file.name)) continue;
        Json example = Json::parse(file.text);
        if (is_range_request(example["request"]) != ranges) continue;
        insert_record(example["request"]);
        examples.push_back(std::move(example));
    }
    return examples;
}

}  // namespace

std::string examples_json() {
    static const std::string text = Json{{"examples", examples_of(false)}, {"ranges", examples_of(true)}}.dump();
    return text;
}

Answer example_request(std::string_view which) {
    Json examples = examples_of(false);
    for (Json& example : examples_of(true)) examples.push_back(std::move(example));
    std::vector<std::string> ids;
    for (const Json& example : examples) {
        ids.push_back(example.at("id"));
        if (which == ids.back() || which == std::to_string(ids.size())) return {200, example.at("request").dump()};
    }
    Problem problem{404, "not-found", "There is no such example", "", {}, {}};
    const std::string meant = nearest(which, ids);
    problem.detail = "There is no example \"" + std::string(which) + "\". " +
                     (meant.empty() ? "Examples are numbered from 1 to " + std::to_string(ids.size()) + "."
                                    : "Did you mean " + meant + "?");
    return refusal(problem);
}

}  // namespace tunewright::api
