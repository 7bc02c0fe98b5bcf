// The options of a command line, and the request that they mean.
#include "api/shorthand.h"

#include "support.h"

namespace tunewright::api {
namespace {

Json request_of(const TuneWords& words, std::optional<std::string> file = std::nullopt) {
    const auto made = tuning_request(words, std::move(file));
    return std::holds_alternative<std::string>(made) ? Json::parse(std::get<std::string>(made)) : Json();
}

std::string refusal_of(const TuneWords& words, std::optional<std::string> file = std::nullopt) {
    const auto made = tuning_request(words, std::move(file));
    return std::holds_alternative<Problem>(made) ? std::get<Problem>(made).detail : "";
}

TEST(Shorthand, WordsBecomeMembersOfTheRequest) {
    TuneWords words;
    words.plant = "2 e^(-3s)/(10s+1)";
    words.methods = {"robust", "simc"};
    words.Ms = "1.6";
    words.baseline = "0.5, 10";
    words.record.time_unit = "min";
    Json expected{{"plant", words.plant}};
    expected["tune"] = Json::parse(R"([{"method": "robust", "Ms": 1.6, "Mt": 1.6}, {"method": "simc"}])");
    expected["units"] = {{"time", "min"}};
    expected["baseline"] = Json::parse(R"({"form": "ideal", "Kp": 0.5, "Ti": 10})");
    EXPECT_EQ(request_of(words), expected);
}

TEST(Shorthand, WordsStandAboveTheFileAndLeaveTheRestOfItAlone) {
    const std::string file =
        R"( {"plant": {"type": "ipdt", "K": 1, "L": 2}, "name": "LIC-3", "tune": [{"method": "simc"}]})";
    EXPECT_EQ(request_of({}, file), Json::parse(file));
    TuneWords words;
    words.methods = {"amigo"};
    Json changed = Json::parse(file);
    changed["tune"] = Json::parse(R"([{"method": "amigo"}])");
    EXPECT_EQ(request_of(words, file), changed);
}

TEST(Shorthand, AnyMemberOfTheRequestIsSetByItsPlace) {
    TuneWords words;
    words.plant = "2 e^(-3s)/(10s+1)";
    words.methods = {"robust", "simc"};
    words.set = {"evaluate.own_step.target=60",
                 "evaluate.own_step.u_max=1e2",
                 "units={\"y\": \"degC\"}",
                 "tune.0.Mks=20",
                 "name=TIC-1",
                 "evaluate.own_step.load.at=output",
                 "controllers.0.form=ideal"};
    Json expected{{"plant", words.plant}};
    expected["tune"] = Json::parse(R"([{"method": "robust", "Mks": 20}, {"method": "simc"}])");
    expected["evaluate"] = Json::parse(R"({"own_step": {"target": 60, "u_max": 100, "load": {"at": "output"}}})");
    expected["units"] = {{"y", "degC"}};
    expected["name"] = "TIC-1";
    expected["controllers"] = Json::parse(R"([{"form": "ideal"}])");
    EXPECT_EQ(request_of(words), expected);
}

TEST(Shorthand, APlaceThatTheRequestDoesNotHaveIsRefusedWithItsName) {
    for (const char* setting :
         {"evaluate", "=1", "evaluate..points=3", "plant.K=2", "tune.7.Ms=1.6", "tune.x=1", ".=1"}) {
        TuneWords words;
        words.plant = "2 e^(-3s)/(10s+1)";
        words.methods = {"robust"};
        words.set = {setting};
        EXPECT_EQ(refusal_of(words).find(std::string("--set is \"") + setting + "\""), 0) << setting;
    }
}

TEST(Shorthand, ATestInAFileBecomesTheRecord) {
    TuneWords words;
    words.record.u = "2";
    words.record.y = "PV";
    words.record.dt = "0.5";
    words.record.u_limits = {"0", "100"};
    const std::string csv = "t,u,PV\n0,1,2\n";
    EXPECT_EQ(
        request_of(words, csv),
        (Json{{"record", {{"csv", csv}, {"columns", {{"u", 2}, {"y", "PV"}}}, {"dt", 0.5}, {"u_limits", {0, 100}}}}}));
    // A log with an object in each line is also a record; a request over several lines is not.
    EXPECT_TRUE(request_of({}, "{\"t\": 0, \"u\": 1}\n{\"t\": 1, \"u\": 2}\n").contains("record"));
    EXPECT_FALSE(request_of({}, "{\n\"plant\": \"1/(s+1)\"}").contains("record"));
}

// Both may hold arrays of objects, and the words plant and record.
TEST(Shorthand, AnObjectIsARequestByItsMembersAndARecordByItsRows) {
    for (const char* file :
         {R"({"ultimate": {"Ku": 2, "Pu": 10}, "tune": [{"method": "simc"}, {"method": "amigo"}]})",
          R"({"plant": {"K": "x"}, "tune": [{"method": "robust", "Ms": 1}, {"method": "robust", "Ms": 2}]})",
          R"({"record": {"t": [0, 1], "u": [1, 2], "y": [3, 4]}})",
          R"x({"points": [{"plant": "1/(s+1)", "at": 1}, {"plant": "2/(s+1)", "at": 2}]})x",
          R"({"model": {"plant": {}}, "tune": [{"method": "simc"}, {"method": "amigo"}]})"})
        EXPECT_EQ(request_of({}, file), Json::parse(file)) << file;
    for (const char* file : {R"({"plant": "Tank 3", "data": [{"t": 0, "u": 1, "y": 2}, {"t": 1, "u": 1, "y": 3}]})",
                             R"({"record": "17", "t": [0, 1], "u": [1, 1], "y": [2, 3]})",
                             R"({"points": [{"t": 0, "u": 1, "y": 2}, {"t": 1, "u": 1, "y": 3}]})",
                             R"({"model": "PT100", "rows": [[0, 1, 2], [1, 1, 3]]})"}) {
        EXPECT_EQ(request_of({}, file), (Json{{"record", {{"csv", file}}}})) << file;
    }
}

TEST(Shorthand, WhatSaysHowACsvFileIsReadIsRefusedWithoutOne) {
    TuneWords words;
    words.record.dt = "0.5";
    EXPECT_NE(refusal_of(words, R"x({"plant": "1/(s+1)"})x").find("--dt is an option for reading a CSV file"),
              std::string::npos);
    words.record.dt = "";
    words.record.u_limits = {"0", "100"};
    words.plant = "1/(s+1)";
    EXPECT_NE(refusal_of(words).find("--u-limits is an option for reading a CSV file"), std::string::npos);
}

TEST(Shorthand, TheModelIsThatOfTheRecord) {
    TuneWords words;
    words.record.model = "sopdt";
    EXPECT_EQ(request_of(words, "t,u,y\n0,1,2\n").at("identify"), Json::parse(R"({"model": "sopdt"})"));
    EXPECT_NE(refusal_of(words, R"x({"plant": "1/(s+1)"})x").find("--model"), std::string::npos);
}

TEST(Shorthand, ARequestMayBeInAnyEncoding) {
    const std::string text = R"x({"plant": "1/(s+1)"})x";
    std::string wide = "\xFF\xFE";
    for (const char c : text) wide += {c, '\0'};
    for (const std::string& file : {"\xEF\xBB\xBF" + text, wide}) EXPECT_EQ(request_of({}, file), Json::parse(text));
}

TEST(Shorthand, NothingAndTwoThingsToTuneAreRefused) {
    TuneWords both;
    both.plant = "1/(s+1)";
    EXPECT_NE(refusal_of(both, "{}").find("Leave one of them out"), std::string::npos);
    EXPECT_NE(refusal_of({}).find("--plant"), std::string::npos);
    EXPECT_NE(refusal_of({}, " \n").find("empty"), std::string::npos);
    EXPECT_NE(refusal_of({}, "{").find("not JSON"), std::string::npos);
    both.baseline = "1 2 3 4";
    EXPECT_NE(refusal_of(both).find("Kp, Ti and Td"), std::string::npos);
}

TEST(Shorthand, OtherMethodsGetMsAloneWhereNoneHoldsLimits) {
    TuneWords words;
    words.plant = "1/(s+1)";
    words.methods = {"arrieta_ms"};
    words.Ms = "1.8";
    EXPECT_EQ(request_of(words).at("tune"), Json::parse(R"([{"method": "arrieta_ms", "Ms": 1.8}])"));
}

TEST(Shorthand, AWordThatIsNoNumberIsLeftForTheContractToRefuse) {
    TuneWords words;
    words.plant = "1/(s+1)";
    words.Ms = "high";
    EXPECT_EQ(request_of(words).at("tune").at(0).at("Ms"), "high");
}

}  // namespace
}  // namespace tunewright::api
