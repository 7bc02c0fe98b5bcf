// The OpenAPI document, the methods and the examples of the service.
#include <set>

#include "api/contract/method_options.h"
#include "api/contract/methods.h"
#include "api/examples/examples.h"
#include "api/openapi/openapi.h"
#include "api/registries.h"
#include "engine/tuning/registry.h"
#include "support.h"

namespace tunewright::api {
namespace {

void collect_references(const Json& value, std::set<std::string>& references) {
    if (value.is_object()) {
        for (const auto& [name, member] : value.items()) {
            if (name == "$ref" && member.is_string()) references.insert(member.get<std::string>());
            collect_references(member, references);
        }
    } else if (value.is_array()) {
        for (const Json& element : value) collect_references(element, references);
    }
}

TEST(OpenApi, EveryReferenceLeadsSomewhere) {
    const Json document = Json::parse(openapi_json());
    std::set<std::string> references;
    collect_references(document, references);
    EXPECT_GT(references.size(), 40u);
    for (const std::string& reference : references) {
        ASSERT_EQ(reference.substr(0, 2), "#/") << reference;
        EXPECT_TRUE(document.contains(Json::json_pointer(reference.substr(1)))) << reference;
    }
}

TEST(OpenApi, HasEveryPathAndOneOperationIdEach) {
    const Json document = Json::parse(openapi_json());
    EXPECT_EQ(document["openapi"], "3.1.0");
    EXPECT_EQ(document["info"]["version"], TUNEWRIGHT_VERSION);
    for (const char* path : {"/v1/jobs",
                             "/v1/jobs/{id}",
                             "/v1/jobs/{id}/events",
                             "/v1/jobs/{id}/cancel",
                             "/v1/jobs/{id}/result.csv",
                             "/v1/batches",
                             "/v1/batches/{id}",
                             "/v1/batches/{id}/results",
                             "/v1/batches/{id}/cancel",
                             "/v1/evaluate",
                             "/v1/identify",
                             "/v1/experiments/relay",
                             "/v1/methods",
                             "/v1/methods/{id}",
                             "/v1/examples",
                             "/openapi.json",
                             "/healthz",
                             "/readyz",
                             "/metrics",
                             "/"}) {
        EXPECT_TRUE(document["paths"].contains(path)) << path;
    }
    std::set<std::string> ids;
    for (const auto& [path, item] : document["paths"].items()) {
        for (const auto& [method, operation] : item.items()) {
            if (method == "parameters") continue;
            EXPECT_TRUE(ids.insert(operation["operationId"].get<std::string>()).second) << path;
            EXPECT_FALSE(operation["responses"].empty()) << path;
        }
    }
}

TEST(OpenApi, EveryFieldOfTheContractHasASentence) {
    const Json document = Json::parse(openapi_json());
    for (const char* name : {"Fopdt", "StateSpace", "IdealController", "Filter", "Evaluate", "Record", "TuningRequest",
                             "Robustness", "SetpointPerformance", "Entry", "TuningResult"}) {
        const Json& schema = document["components"]["schemas"][name];
        EXPECT_GT(schema["description"].get<std::string>().size(), 10u) << name;
        for (const auto& [field, property] : schema["properties"].items()) {
            if (property.contains("const")) continue;
            EXPECT_FALSE(property.value("description", "").empty()) << name << "." << field;
        }
    }
}

TEST(OpenApi, CarriesTheDefaultsAndUnitsOfTheDescriptions) {
    const Json schemas = Json::parse(openapi_json())["components"]["schemas"];
    EXPECT_EQ(schemas["Evaluate"]["properties"]["points"]["default"], 400);
    EXPECT_EQ(schemas["TuningRequest"]["properties"]["timeout_s"]["default"], 60);
    EXPECT_EQ(schemas["Fopdt"]["properties"]["L"]["x-unit"], "time");
    EXPECT_EQ(schemas["Fopdt"]["properties"]["L"]["minimum"], 0);
    EXPECT_EQ(schemas["Fopdt"]["required"], (Json{"type", "K", "T", "L"}));
    EXPECT_EQ(schemas["Zpk"]["required"], (Json{"type", "K", "poles"}));
}

TEST(Methods, EachIsListedWithTextsAndOptions) {
    const Json methods = Json::parse(methods_json())["methods"];
    ASSERT_EQ(methods.size(), method_registry().size());
    std::set<std::string> ids;
    for (const Json& method : methods) {
        ids.insert(method["id"].get<std::string>());
        EXPECT_EQ(schema_faults(method, "MethodDescription"), std::vector<std::string>{}) << method["id"];
        for (const char* text : {"title", "formula", "needs", "validity", "source"})
            EXPECT_FALSE(method[text].get<std::string>().empty()) << method["id"] << text;
        EXPECT_EQ(Json::parse(method_json(method["id"].get<std::string>()).body), method);
    }
    for (const char* id : {"robust", "amigo", "simc", "ziegler_nichols_step", "lambda"})
        EXPECT_TRUE(ids.contains(id)) << id;
}

TEST(Methods, DefaultsKeepTheirOwnRules) {
    for (const TuningMethod& method : method_registry()) {
        const Json schema = options_schema(method.options);
        Json defaults = Json::object();
        for (const auto& [name, option] : schema["properties"].items()) {
            if (option.contains("default")) defaults[name] = option["default"];
        }
        EXPECT_EQ(schema_faults(defaults, schema, Json::object()), std::vector<std::string>{}) << method.id;
        defaults["method"] = method.id;
        const auto answer = prepare_job(request_with("\"tune\": [" + defaults.dump() + "]"));
        EXPECT_TRUE(std::holds_alternative<PreparedJob>(answer))
            << method.id << ": " << std::get<Problem>(answer).detail;
    }
}

TEST(Methods, AnUnknownOneIsNotFoundWithTheNearestName) {
    const Answer answer = method_json("rubust");
    EXPECT_EQ(answer.status, 404);
    EXPECT_NE(answer.body.find("Did you mean robust?"), std::string::npos) << answer.body;
    EXPECT_EQ(schema_faults(Json::parse(answer.body), "Problem"), std::vector<std::string>{});
}

TEST(Examples, AreAcceptedUnchangedAndFitTheDocument) {
    const Json document = Json::parse(examples_json());
    EXPECT_EQ(schema_faults(document, "ExampleList"), std::vector<std::string>{});
    ASSERT_GE(document["examples"].size(), 8u);
    std::set<std::string> ids;
    for (const Json& example : document["examples"]) {
        EXPECT_TRUE(ids.insert(example["id"].get<std::string>()).second);
        const auto answer = prepare_job(example["request"].dump());
        EXPECT_TRUE(std::holds_alternative<PreparedJob>(answer))
            << example["id"] << ": " << std::get<Problem>(answer).detail;
    }
}

}  // namespace
}  // namespace tunewright::api
