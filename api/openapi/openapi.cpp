#include "api/openapi/openapi.h"

#include <set>
#include <string>

#include "api/contract/check/check_request.h"
#include "api/contract/check/check_result.h"
#include "api/contract/controller_record.h"
#include "api/contract/device/experiment_question.h"
#include "api/contract/plant/typed.h"
#include "api/contract/preview.h"
#include "api/contract/product/conversion.h"
#include "api/contract/product/product.h"
#include "api/contract/range/range_experiments.h"
#include "api/contract/range/range_request.h"
#include "api/contract/range/range_result.h"
#include "api/contract/relay.h"
#include "api/contract/reports/frontier.h"
#include "api/contract/request.h"
#include "api/contract/result/identified_model.h"
#include "api/contract/result/result.h"
#include "api/contract/result/verify_call.h"
#include "api/contract/score/score_call.h"
#include "api/contract/structure/cascade_call.h"
#include "api/contract/structure/feedforward_call.h"
#include "api/contract/structure/interaction_call.h"
#include "api/contract/structure/level_call.h"
#include "api/contract/structure/predictor_call.h"
#include "api/describe/answers.h"
#include "api/embed/files.h"
#include "api/examples/examples.h"

namespace tunewright::api {
namespace {

/// Adds the answers that any call may have, such as refusals of the port, unless the operation describes its own.
void add_refusals(Json& operation, bool changes) {
    const auto add = [&](const char* status, const char* name) {
        Json& responses = operation["responses"];
        if (!responses.contains(status)) responses[status] = {{"$ref", std::string("#/components/responses/") + name}};
    };
    add("400", "Unreadable");
    add("401", "Unauthorized");
    add("403", "Forbidden");
    add("406", "NotAcceptable");
    add("421", "Misdirected");
    add("429", "TooMany");
    add("503", "Unavailable");
    add("default", "Refused");
    if (changes) add("507", "DiskFull");
    if (!operation.contains("requestBody")) return;
    add("413", "TooLarge");
    add("415", "WrongMediaType");
}

/// Collects the names of the components that `part` refers to, directly or through others.
void collect_references(const Json& part, const Json& schemas, std::set<std::string>& names) {
    if (part.is_object() && part.contains("$ref")) {
        const auto target = part["$ref"].get<std::string>();
        const std::string name = target.substr(target.rfind('/') + 1);
        if (schemas.contains(name) && names.insert(name).second) collect_references(schemas[name], schemas, names);
    }
    if (!part.is_structured()) return;
    for (const auto& inner : part) collect_references(inner, schemas, names);
}

/// A type that only answers have requires all members that are always written, and has no defaults; a type that
/// requests may have too keeps the mark.
void require_what_is_written(Json& document) {
    Json& schemas = document["components"]["schemas"];
    std::set<std::string> asked;
    for (const auto& item : document["paths"])
        for (const auto& operation : item)
            if (operation.is_object() && operation.contains("requestBody"))
                collect_references(operation["requestBody"], schemas, asked);
    for (auto& [name, schema] : schemas.items()) {
        if (!schema.contains(kWritten) || asked.contains(name)) continue;
        if (!schema[kWritten].empty()) schema["required"] = schema[kWritten];
        schema.erase(kWritten);
        for (auto& property : schema["properties"]) property.erase("default");
    }
}

}  // namespace

// paths.json describes the HTTP side: paths, parameters, the job around a request. The types of the contract come from
// their descriptions.
std::string openapi_json() {
    static const std::string text = [] {
        Json document = Json::parse(embedded_file("openapi/paths.json"));
        document["info"]["version"] = TUNEWRIGHT_VERSION;
        SchemaBook book;
        job_contract().schema(book);
        result_contract().schema(book);
        design_request_contract().schema(book);
        design_answer_contract().schema(book);
        frontier_request_contract().schema(book);
        frontier_contract().schema(book);
        check_request_contract().schema(book);
        check_result_contract().schema(book);
        check_answer_contract().schema(book);
        batch_check_contract().schema(book);
        range_request_contract().schema(book);
        range_result_contract().schema(book);
        range_answer_contract().schema(book);
        range_experiments_contract().schema(book);
        range_experiments_answer_contract().schema(book);
        cascade_request_contract().schema(book);
        cascade_answer_contract().schema(book);
        level_request_contract().schema(book);
        score_request_contract().schema(book);
        score_answer_contract().schema(book);
        verify_request_contract().schema(book);
        verify_answer_contract().schema(book);
        level_answer_contract().schema(book);
        feedforward_request_contract().schema(book);
        feedforward_answer_contract().schema(book);
        interaction_request_contract().schema(book);
        interaction_answer_contract().schema(book);
        predictor_request_contract().schema(book);
        predictor_answer_contract().schema(book);
        evaluate_request_contract().schema(book);
        evaluate_answer_contract().schema(book);
        identify_request_contract().schema(book);
        identify_answer_contract().schema(book);
        controller_record_request_contract().schema(book);
        controller_record_answer_contract().schema(book);
        plant_question_contract().schema(book);
        plant_answer_contract().schema(book);
        preview_request_contract().schema(book);
        preview_answer_contract().schema(book);
        relay_request_contract().schema(book);
        experiment_contract().schema(book);
        relay_answer_contract().schema(book);
        product_summary_contract().schema(book);
        product_contract().schema(book);
        settings_request_contract().schema(book);
        settings_answer_contract().schema(book);
        schedule_settings_request_contract().schema(book);
        schedule_settings_answer_contract().schema(book);
        twin_request_contract().schema(book);
        twin_answer_contract().schema(book);
        Json& schemas = document["components"]["schemas"];
        for (auto& [name, schema] : book.components.items()) schemas[name] = schema;
        require_what_is_written(document);

        for (auto& [path, item] : document["paths"].items())
            for (auto& [method, operation] : item.items())
                if (operation.is_object()) add_refusals(operation, method != "get");

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
