// Calls about products: the lists match the document, and conversions answer according to the contract.
#include <gmock/gmock.h>

#include "api/contract/product/conversion.h"
#include "api/registries.h"
#include "engine/controller/product/catalogue.h"
#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using Faults = std::vector<std::string>;

const Json kDesign = {
    {"Kp", 1.5}, {"Ti", 120}, {"Td", 20}, {"b", 0.6}, {"filter", {{"type", "derivative"}, {"Tf", 2}}}};
const Json kRequest = {{"controller", kDesign}, {"y_span", {0, 200}}, {"u_span", {0, 100}}, {"sample_time", 0.25}};

Json with(const Json& more, Json request = kRequest) {
    request.update(more);
    return request;
}
Json answered(const Answer& answer) {
    EXPECT_EQ(answer.status, 200) << answer.body;
    return Json::parse(answer.body);
}
Json settings_of(const std::string& id, const Json& request = kRequest) {
    return answered(controller_settings_call(id, request.dump()));
}
/// Expected status, type, and detail at the pointer.
struct Refused {
    int status;
    std::string type, detail;
};
Refused refused(const Answer& answer, std::string_view pointer = "") {
    const Json problem = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(problem, "Problem"), Faults{});
    Refused out{answer.status, problem["type"], problem["detail"]};
    if (pointer.empty()) return out;
    std::vector<FieldError> errors;
    for (const Json& error : problem.value("errors", Json::array()))
        errors.push_back({error["pointer"], error["detail"]});
    out.detail = detail_at(errors, pointer);
    return out;
}

TEST(Controllers, TheListAndEveryEntryKeepTheDocument) {
    const Json list = Json::parse(controllers_json());
    EXPECT_EQ(schema_faults(list, "ControllerList"), Faults{});
    EXPECT_EQ(list["controllers"].size(), 64U);
    for (const Json& entry : list["controllers"]) {
        const Json one = answered(controller_json(entry["id"].get<std::string>()));
        EXPECT_EQ(schema_faults(one, "ControllerProduct"), Faults{}) << entry["id"];
        EXPECT_EQ(one["parameters"].size(), entry["parameters"].size());
        EXPECT_EQ(one["evidence"]["level"], entry["evidence"]);
    }
}

TEST(Controllers, EveryExampleCanBeSentAsItStands) {
    for (const auto& product : product::catalogue()) {
        const Json entry = answered(controller_json(product.id));
        Json request = entry["example"];
        const Json settings = request["settings"];
        request.erase("settings");
        const Answer answer = controller_settings_call(product.id, request.dump());
        ASSERT_EQ(answer.status, 200) << product.id << ": " << answer.body;
        const Json body = Json::parse(answer.body);
        EXPECT_EQ(schema_faults(body, "SettingsAnswer"), Faults{}) << product.id;
        for (const auto& [name, value] : settings.items())
            EXPECT_TRUE(body["settings"].contains(name) && body["as_typed"].contains(name)) << product.id << name;
        request.erase("controller");
        request["settings"] = body["settings"];
        const Json twin = answered(controller_twin_call(product.id, request.dump()));
        EXPECT_EQ(schema_faults(twin, "ProductController"), Faults{}) << product.id;
    }
}

TEST(Controllers, NeedsNameWhatAConversionCannotDoWithout) {
    for (const auto& product : product::catalogue()) {
        const Json entry = answered(controller_json(product.id));
        Json request{{"controller", kDesign}};
        for (const Json& need : entry["needs"]) {
            const auto name = need.get<std::string>();
            const Answer without = controller_settings_call(product.id, request.dump());
            EXPECT_EQ(without.status, 422) << product.id << " without " << name;
            request[name] = kRequest[name];
        }
        const Answer answer = controller_settings_call(product.id, request.dump());
        EXPECT_EQ(answer.status, 200) << product.id << ": " << answer.body;
    }
}

TEST(Controllers, SettingsComeInFullPrecisionAsTypedAndWithWhatTheyDo) {
    const Json body = settings_of("siemens_pid_compact");
    EXPECT_EQ(body["settings"]["Gain"], 1.5);
    EXPECT_EQ(body["as_typed"]["Gain"], "1.50");
    EXPECT_EQ(body["units"]["Ti"], "s");
    EXPECT_FALSE(body["units"].contains("PWeighting"));
    EXPECT_EQ(body["realised"]["form"], "ideal");
    EXPECT_EQ(body["realised"]["b"], 0.6);
    EXPECT_EQ(body["realised"]["filter"]["Tf"], 2);
    EXPECT_EQ(body["notes"][0]["code"], "discretisation");

    const Json deltav = settings_of("emerson_deltav_series");
    EXPECT_NEAR(deltav["settings"]["RESET"], 93.1174, 5e-5);
    EXPECT_EQ(deltav["as_typed"]["RESET"], "93.12");
    EXPECT_NEAR(deltav["realised"]["b"], 0.775978, 5e-7);
    EXPECT_NEAR(deltav["realised"]["filter"]["Tf"], 3.84037, 5e-6);
}

const Json kRows = {{{"at", 20}, {"Kp", 3}, {"Ti", 90}, {"Td", 15}, {"Tf", 0}, {"b", 1}},
                    {{"at", 60}, {"Kp", 1.5}, {"Ti", 120}, {"Td", 20}, {"Tf", 0}, {"b", 1}},
                    {{"at", 80}, {"Kp", 1}, {"Ti", 150}, {"Td", 25}, {"Tf", 0}, {"b", 1}},
                    {{"at", 90}, {"Kp", 0.8}, {"Ti", 160}, {"Td", 26}, {"Tf", 0}, {"b", 1}}};

Json schedule_request(const Json& more = Json::object()) {
    Json request = with({{"rows", kRows}, {"interpolation", "steps"}});
    request.erase("controller");
    request.update(more);
    return request;
}
Json schedule_of(const std::string& id, const Json& more = Json::object()) {
    return answered(controller_schedule_call(id, schedule_request(more).dump()));
}
std::vector<std::string> codes(const Json& notes) {
    std::vector<std::string> all;
    for (const Json& note : notes) all.push_back(note["code"]);
    return all;
}

TEST(ControllerSchedule, EachRowIsTypedAsItWouldBeAlone) {
    for (const auto& product : product::catalogue()) {
        const Json body = schedule_of(std::string(product.id), {{"nearest", true}});
        EXPECT_EQ(schema_faults(body, "ScheduleSettingsAnswer"), Faults{}) << product.id;
        ASSERT_EQ(body["rows"].size(), 4U) << product.id;
        for (std::size_t k = 0; k < 4; ++k) {
            Json row = kRows[k];
            row.erase("at");
            row.erase("Tf");
            const Json alone = settings_of(std::string(product.id), with({{"controller", row}, {"nearest", true}}));
            EXPECT_EQ(body["rows"][k]["at"], kRows[k]["at"]);
            const Json& typing = body["rows"][k]["typing"];
            for (const char* part : {"settings", "as_typed", "realised", "units"})
                EXPECT_EQ(typing[part], alone[part]) << product.id << " row " << k << " " << part;
            // A note is given once, for its row or for all of them.
            for (const Json& note : alone["notes"]) {
                const auto count = [&](const Json& in) { return std::count(in.begin(), in.end(), note); };
                EXPECT_EQ(count(typing["notes"]) + count(body["notes"]), 1) << product.id << note;
            }
        }
    }
}

TEST(ControllerSchedule, SaysWhatTheProductDoesBetweenTheRows) {
    EXPECT_EQ(codes(schedule_of("emerson_deltav_standard")["notes"])[0], "too-many-rows");
    EXPECT_THAT(codes(schedule_of("labview_pid")["notes"]), testing::Not(testing::Contains("interpolation")));
    const Json linear = schedule_of("labview_pid", {{"interpolation", "linear_in_gains"}});
    EXPECT_EQ(codes(linear["notes"])[0], "interpolation");
    EXPECT_THAT(linear["notes"][0]["detail"].get<std::string>(), HasSubstr("Design it with interpolation = steps"));
    EXPECT_THAT(codes(schedule_of("simulink_pid_ideal", {{"interpolation", "linear_in_gains"}})["notes"]),
                testing::Not(testing::Contains("interpolation")));
    EXPECT_EQ(codes(schedule_of("simulink_pid_parallel", {{"interpolation", "linear_in_gains"}})["notes"])[0],
              "interpolation");
    EXPECT_EQ(codes(schedule_of("arduino_pid_v1", {{"nearest", true}})["notes"])[0], "no-gain-scheduling");
    EXPECT_EQ(answered(controller_json("emerson_deltav_series"))["gain_scheduling"]["sets"], 3);
    EXPECT_EQ(answered(controller_json("labview_pid"))["gain_scheduling"]["interpolation"], "steps");
    EXPECT_FALSE(answered(controller_json("marlin")).contains("gain_scheduling"));
}

TEST(ControllerSchedule, WhatCannotBeIsNamedAtItsRow) {
    Json rows = kRows;
    rows[2]["Ti"] = 40;  // below 4 Td: complex zeros, which a series form cannot have
    const auto series = [&](const Json& more) {
        return controller_schedule_call("emerson_deltav_series", schedule_request(more).dump());
    };
    EXPECT_EQ(refused(series({{"rows", rows}}), "/rows/2").type, "not-representable");
    EXPECT_EQ(series({{"rows", rows}, {"nearest", true}}).status, 200);
    rows[2]["at"] = 20;
    EXPECT_THAT(refused(series({{"rows", rows}}), "/rows/2/at").detail, HasSubstr("must ascend"));
    EXPECT_THAT(refused(series({{"rows", Json::array()}}), "/rows").detail, HasSubstr("it must have 1 to 20"));
    EXPECT_EQ(controller_schedule_call("nobody", schedule_request().dump()).status, 404);
}

TEST(Controllers, TimesAreInTheRequestsUnit) {
    Json minutes = kDesign;
    minutes["Ti"] = 2;
    minutes["Td"] = 1.0 / 3;
    minutes["filter"]["Tf"] = 1.0 / 30;
    const Json body = settings_of(
        "openplc_iec_pid", with({{"controller", minutes}, {"sample_time", 0.25 / 60}, {"units", {{"time", "min"}}}}));
    EXPECT_NEAR(body["settings"]["TR"], 120, 1e-12);
    EXPECT_NEAR(body["settings"]["CYCLE_s"], 0.25, 1e-15);
    EXPECT_NEAR(body["realised"]["Ti"], 2, 1e-13);
    EXPECT_THAT(
        refused(controller_settings_call("simple_pid", with({{"units", {{"time", "moon"}}}}).dump()), "/units/time")
            .detail,
        HasSubstr("not a known unit of time"));
}

TEST(Controllers, OtherFormsAreTaken) {
    const Json parallel = {
        {"form", "parallel"}, {"Kp", 1.5}, {"Ki", 0.0125}, {"Kd", 30}, {"filter", {{"type", "derivative"}, {"Tf", 2}}}};
    EXPECT_NEAR(settings_of("siemens_pid_compact", with({{"controller", parallel}}))["settings"]["Ti"], 120, 1e-12);
    const Json pure_integral = {{"form", "parallel"}, {"Ki", 0.1}};
    const Refused none =
        refused(controller_settings_call("simple_pid", with({{"controller", pure_integral}}).dump()), "/controller");
    EXPECT_EQ(none.type, "not-representable");
    EXPECT_THAT(none.detail, HasSubstr("Kp is 0 while Ki = 0.1"));
    const Json nonlinear = {{"form", "npid"}, {"Kp", 1.5}, {"Ti", 120}};
    EXPECT_EQ(refused(controller_settings_call("simple_pid", with({{"controller", nonlinear}}).dump())).type,
              "not-representable");
    EXPECT_EQ(settings_of("simple_pid", with({{"controller", nonlinear}, {"nearest", true}}))["settings"]["Kp"], 1.5);
}

TEST(Controllers, WhatABlockCannotBeIsRefusedOrMadeNearest) {
    Json complex = kDesign;
    complex["Ti"] = 60;
    const Json request = with({{"controller", complex}});
    const Refused no = refused(controller_settings_call("emerson_deltav_series", request.dump()));
    EXPECT_EQ(no.status, 422);
    EXPECT_EQ(no.type, "not-representable");
    EXPECT_THAT(no.detail, HasSubstr("The nearest settings: both times"));
    const Json body = settings_of("emerson_deltav_series", with({{"nearest", true}}, request));
    EXPECT_EQ(body["notes"][0]["code"], "nearest");
}

TEST(Controllers, MissingRangesAndPeriodsAreNamed) {
    const auto missing = [](const std::string& id, Json request, const std::string& pointer) {
        request.erase(pointer.substr(1));
        return refused(controller_settings_call(id, request.dump()), pointer).detail;
    };
    EXPECT_THAT(missing("emerson_deltav_series", kRequest, "/y_span"), HasSubstr("such as \"y_span\": [0, 200]"));
    EXPECT_THAT(missing("klipper", kRequest, "/u_span"), HasSubstr("u_span is missing"));
    EXPECT_THAT(missing("esphome_pid", kRequest, "/sample_time"), HasSubstr("Give the period"));
    const Answer turned = controller_settings_call("simple_pid", with({{"y_span", {200, 0}}}).dump());
    EXPECT_THAT(refused(turned, "/y_span").detail, HasSubstr("its first number must be below the second"));
}

TEST(Controllers, SettingsGiveTheirTwin) {
    const Json request = {{"settings", {{"GAIN", 2.32793}, {"RESET", 93.1174}, {"RATE", 30.723}, {"ALPHA", 0.125}}},
                          {"y_span", {0, 200}},
                          {"u_span", {0, 100}}};
    const Json body = answered(controller_twin_call("emerson_deltav_series", request.dump()));
    EXPECT_NEAR(body["controller"]["Kp"], 1.5, 1e-5);
    EXPECT_NEAR(body["controller"]["Ti"], 120, 1e-3);
    EXPECT_NEAR(body["controller"]["Td"], 20, 1e-4);
    EXPECT_EQ(body["notes"], Json::array());
}

TEST(Controllers, WrongSettingsAreRefusedAtTheirPlace) {
    const auto detail = [](const Json& settings, std::string_view pointer) {
        return refused(controller_twin_call("simple_pid", Json{{"settings", settings}}.dump()), pointer).detail;
    };
    EXPECT_THAT(detail({{"kp", 1}}, "/settings/kp"), HasSubstr("Did you mean Kp?"));
    EXPECT_THAT(detail({{"Kp", "1"}}, "/settings/Kp"), HasSubstr("it must be a number"));
    EXPECT_THAT(detail({{"Kp", nullptr}}, "/settings/Kp"), HasSubstr("it must be a number, a short string"));
    EXPECT_THAT(detail({{"Ki", 1}}, "/settings/Kp"), HasSubstr("Kp is missing"));
    EXPECT_THAT(detail(3, "/settings"), HasSubstr("it must be an object"));
    EXPECT_THAT(detail({{"Kp", 1}, {"proportional_on_measurement", 1}}, "/settings/proportional_on_measurement"),
                HasSubstr("it must be false or true"));
}

TEST(Controllers, AnUnknownIdIs404WithASuggestion) {
    for (const Answer& answer : {controller_json("klippr"), controller_settings_call("klippr", "{}"),
                                 controller_twin_call("klippr", "not JSON")}) {
        EXPECT_EQ(refused(answer).status, 404);
        EXPECT_THAT(refused(answer).detail, HasSubstr("Did you mean klipper?"));
    }
    EXPECT_THAT(refused(controller_json("pneumatic")).detail, HasSubstr("GET /v1/controllers"));
}

}  // namespace
}  // namespace tunewright::api
