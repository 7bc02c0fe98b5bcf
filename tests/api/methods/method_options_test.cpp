// Options of every shape: the path of the stored value, the place of a fault, the echo.
#include "api/contract/method_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/describe/reader.h"
#include "api/registries.h"
#include "api/service.h"
#include "engine/tuning/limits.h"

namespace tunewright::api {
namespace {

OptionDescription option(const std::string& name, OptionType type) {
    OptionDescription described;
    described.name = name;
    described.type = type;
    described.sentence = "For this test.";
    return described;
}

std::vector<OptionDescription> described() {
    OptionDescription low_high = option("Kp", OptionType::range);
    OptionDescription bounds = option("bounds", OptionType::object);
    bounds.fields = {low_high};
    OptionDescription Tf = option("Tf", OptionType::number_or_range);
    Tf.exclusive_minimum = 0;
    OptionDescription poles = option("poles", OptionType::list);
    poles.fields = {option("pole", OptionType::complex)};
    poles.max = 3;
    OptionDescription step = option("setpoint_step", OptionType::number);
    step.required = true;
    OptionDescription scenario = option("scenario", OptionType::object);
    scenario.fields = {step, option("initial", OptionType::numbers_by_name)};
    OptionDescription scenarios = option("scenarios", OptionType::list);
    scenarios.fields = {scenario};
    OptionDescription methods = option("methods", OptionType::list);
    methods.fields = {option("method", OptionType::text)};
    return {bounds, Tf, poles, scenarios, methods};
}

TEST(MethodOptions, TheDescriptionOfRobustHasTheEnginesLimits) {
    const Json described = Json::parse(methods_json());
    for (const Json& method : described["methods"]) {
        if (method["id"] != "robust") continue;
        const Json& options = method["options"]["properties"];
        EXPECT_EQ(options["Ms"]["default"], limits::kDefaultMs);
        EXPECT_EQ(options["Ms"]["maximum"], limits::kMaxMs);
        EXPECT_EQ(options["Mt"]["default"], limits::kDefaultMt);
        EXPECT_EQ(options["Mt"]["maximum"], limits::kMaxMt);
        return;
    }
    FAIL() << "the method robust is not described";
}

TEST(MethodOptions, OnesThatStandInPlaceOfAnotherSaySoAndAreNotGivenWithIt) {
    int found = 0;
    const Json answered = Json::parse(methods_json());
    for (const Json& method : answered["methods"])
        for (const auto& [name, option] : method["options"]["properties"].items()) {
            const std::string sentence = option.value("description", ""), opening = "In place of ";
            const bool says = sentence.starts_with(opening), known = option.contains("x-in-place-of");
            EXPECT_EQ(says, known) << method["id"] << " " << name;
            if (!says || !known) continue;
            ++found;
            const std::string other = option["x-in-place-of"];
            EXPECT_TRUE(sentence.starts_with(opening + other + ":")) << sentence;
            const Json request{{"plant", {{"type", "fopdt"}, {"K", 1}, {"T", 10}, {"L", 3}}},
                               {"tune", {{{"method", method["id"]}, {name, 2}, {other, 8}}}}};
            const Answer answer = design_call(request.dump(), {});
            EXPECT_EQ(answer.status, 422) << answer.body;
            EXPECT_EQ(Json::parse(answer.body)["errors"].size(), 1u) << answer.body;
        }
    EXPECT_GE(found, 3);
}

struct Outcome {
    MethodOptions options;
    std::vector<std::string> faults;  // "pointer: sentence"
};

Outcome read(const char* text) {
    Outcome outcome;
    Reader reader;
    read_options(Json::parse(text), described(), "this", outcome.options, reader);
    if (const auto problem = reader.problem())
        for (const FieldError& error : problem->errors) outcome.faults.push_back(error.pointer + ": " + error.detail);
    return outcome;
}

Json written(const MethodOptions& options) {
    Json object = Json::object();
    for (const auto& [path, value] : options.values()) place_option(object, path, value);
    return object;
}

nlohmann::json unordered(const Json& value) { return nlohmann::json::parse(value.dump()); }

TEST(MethodOptions, EveryShapeIsWrittenBackAsItWasGiven) {
    const char* text =
        R"({"bounds": {"Kp": [-2.0, -1.0]}, "Tf": [0.05, 0.2], "poles": [-1.0, [-2.0, 3.0], [-2.0, -3.0]],
            "scenarios": [{"setpoint_step": 10.0}, {"setpoint_step": 0.0, "initial": {"T": 1.0, "T2": 2.0}}],
            "methods": ["imc", "simc"]})";
    const Outcome outcome = read(text);
    EXPECT_THAT(outcome.faults, testing::IsEmpty());
    EXPECT_EQ(unordered(written(outcome.options)), unordered(Json::parse(text)));
}

TEST(MethodOptions, ListsOfMoreThanTenKeepTheirOrder) {
    Json list = Json::array();
    for (int i = 0; i < 12; ++i) list.push_back({{"setpoint_step", double(i)}});
    const Json given{{"scenarios", list}};
    const Outcome outcome = read(given.dump().c_str());
    EXPECT_EQ(outcome.options.size("scenarios"), 12u);
    EXPECT_EQ(outcome.options.number("scenarios/10/setpoint_step"), 10);
    EXPECT_EQ(written(outcome.options), given);
}

TEST(MethodOptions, PathsLeadToNumbersRangesAndNames) {
    const Outcome outcome = read(
        R"({"bounds": {"Kp": [1, 2]}, "Tf": 0.1, "scenarios": [{"setpoint_step": 1, "initial": {"b": 2, "a": 1}}]})");
    EXPECT_EQ(outcome.options.range("bounds/Kp")->low, 1);
    EXPECT_EQ(outcome.options.range("bounds/Kp")->high, 2);
    EXPECT_FALSE(outcome.options.range("Tf"));
    EXPECT_EQ(outcome.options.number("Tf"), 0.1);
    EXPECT_EQ(outcome.options.size("poles"), 0u);
    EXPECT_THAT(outcome.options.names("scenarios/0/initial"), testing::ElementsAre("a", "b"));
}

TEST(MethodOptions, FaultsStandAtTheirPlaceWithTheRule) {
    EXPECT_THAT(read(R"({"bounds": {"Kp": [2, 1]}})").faults,
                testing::ElementsAre("/bounds/Kp: Kp is [2,1]; the first number must be below the second."));
    EXPECT_THAT(read(R"({"bounds": {"Kp": [1]}})").faults,
                testing::ElementsAre("/bounds/Kp: Kp has 1 elements; it must be [low, high]."));
    EXPECT_THAT(read(R"({"Tf": [0, 1]})").faults, testing::ElementsAre("/Tf/0: Tf[0] is 0; it must be > 0."));
    EXPECT_THAT(read(R"({"Tf": "fast"})").faults,
                testing::ElementsAre("/Tf: Tf is \"fast\", a string; it must be a number or [low, high]."));
    EXPECT_THAT(read(R"({"poles": [-1, -2, -3, -4]})").faults,
                testing::ElementsAre("/poles: poles has 4 elements; it must have 1 to 3."));
    EXPECT_THAT(read(R"({"scenarios": [{"initial": {"T": 1}}]})").faults,
                testing::ElementsAre("/scenarios/0/setpoint_step: setpoint_step is missing."));
    EXPECT_THAT(read(R"({"scenarios": [{"setpoint_step": 1, "initial": {"a/b": 1}}]})").faults,
                testing::ElementsAre(testing::HasSubstr("is not a valid name; a name has letters, digits and _")));
    EXPECT_THAT(read(R"({"scenarios": [{"setpoint_step": 1, "load": 2}]})").faults,
                testing::ElementsAre(testing::HasSubstr("load is not an option of scenarios[0]")));
    EXPECT_THAT(read(R"({"methods": [1]})").faults,
                testing::ElementsAre("/methods/0: methods[0] is 1, a number; it must be a string."));
}

TEST(MethodOptions, SchemasSayWhatReadingTakes) {
    const Json schema = options_schema(described())["properties"];
    EXPECT_EQ(schema["bounds"]["properties"]["Kp"]["minItems"], 2);
    EXPECT_EQ(schema["Tf"]["oneOf"][0]["exclusiveMinimum"], 0);
    EXPECT_EQ(schema["Tf"]["oneOf"][1]["items"]["exclusiveMinimum"], 0);
    EXPECT_EQ(schema["poles"]["maxItems"], 3);
    EXPECT_EQ(schema["scenarios"]["items"]["required"], Json{"setpoint_step"});
    EXPECT_EQ(schema["scenarios"]["items"]["properties"]["initial"]["additionalProperties"]["type"], "number");
}

TEST(MethodOptions, MisfitsOfPartsAreToldByPath) {
    const auto options = described();
    EXPECT_FALSE(misfit(options, "bounds/Kp/0", 1.0));
    EXPECT_FALSE(misfit(options, "scenarios/3/initial/T", 1.0));
    EXPECT_FALSE(misfit(options, "poles/1/0", 1.0));
    EXPECT_TRUE(misfit(options, "scenarios/3/load", 1.0));
    EXPECT_TRUE(misfit(options, "Tf/0", -1.0));
    EXPECT_TRUE(misfit(options, "methods/0", 1.0));
}

}  // namespace
}  // namespace tunewright::api
