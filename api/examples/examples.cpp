#include "api/embed/files.h"
#include "api/json/json.h"
#include "api/service.h"

namespace tunewright::api {
namespace {

bool is_example(std::string_view name) {
    constexpr std::string_view kFolder = "examples/", kEnd = ".json";
    return name.substr(0, kFolder.size()) == kFolder && name.size() > kEnd.size() &&
           name.substr(name.size() - kEnd.size()) == kEnd;
}

// A record's csv names a file of the folder here and holds its text in the answer.
void insert_record(Json& request) {
    if (!request.contains("record")) return;
    Json& csv = request["record"]["csv"];
    csv = std::string(embedded_file("examples/" + csv.get<std::string>()));
}

}  // namespace

std::string examples_json() {
    static const std::string text = [] {
        Json examples = Json::array();
        for (const EmbeddedFile& file : embedded_files()) {
            if (!is_example(file.name)) continue;
            Json example = Json::parse(file.text);
            insert_record(example["request"]);
            examples.push_back(std::move(example));
        }
        return Json{{"examples", std::move(examples)}}.dump();
    }();
    return text;
}

}  // namespace tunewright::api
