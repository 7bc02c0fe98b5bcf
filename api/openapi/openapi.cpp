#include "api/contract/relay.h"
#include "api/contract/request.h"
#include "api/contract/result.h"
#include "api/embed/files.h"
#include "api/service.h"

namespace tunewright::api {

// paths.json holds what belongs to HTTP: paths, parameters, the job around a request. The types of the contract come
// from their descriptions.
std::string openapi_json() {
    static const std::string text = [] {
        Json document = Json::parse(embedded_file("openapi/paths.json"));
        document["info"]["version"] = TUNEWRIGHT_VERSION;
        SchemaBook book;
        job_contract().schema(book);
        result_contract().schema(book);
        evaluate_request_contract().schema(book);
        evaluate_answer_contract().schema(book);
        identify_request_contract().schema(book);
        identify_answer_contract().schema(book);
        relay_request_contract().schema(book);
        relay_answer_contract().schema(book);
        Json& schemas = document["components"]["schemas"];
        for (auto& [name, schema] : book.components.items()) schemas[name] = schema;

        const Json examples = Json::parse(examples_json());
        Json& shown = document["paths"]["/v1/jobs"]["post"]["requestBody"]["content"]["application/json"]["examples"];
        for (const Json& example : examples["examples"]) {
            if (example["request"].contains("record")) continue;
            shown[example["id"].get<std::string>()] = {{"summary", example["title"]}, {"value", example["request"]}};
        }
        return document.dump();
    }();
    return text;
}

}  // namespace tunewright::api
