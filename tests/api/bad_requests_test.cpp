// Every kind of bad input gets its status, the place and a helpful sentence.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <variant>

#include "api/examples/examples.h"
#include "support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

struct BadRequest {
    const char* name;
    std::string body;
    int status;
    const char* pointer;  // null: no list of faults
    const char* sentence;
};

void PrintTo(const BadRequest& bad, std::ostream* out) { *out << bad.name; }
std::string case_name(const testing::TestParamInfo<BadRequest>& bad) { return bad.param.name; }
std::string with_plant(const std::string& plant) { return R"({"plant": )" + plant + "}"; }
std::string with_record(const std::string& record) { return R"({"record": )" + record + "}"; }

class Refuses : public testing::TestWithParam<BadRequest> {};

TEST_P(Refuses, WithStatusPlaceAndCure) {
    const BadRequest& bad = GetParam();
    const auto answer = prepare_job(bad.body);
    ASSERT_TRUE(std::holds_alternative<Problem>(answer)) << "accepted: " << bad.body.substr(0, 200);
    const Problem& problem = std::get<Problem>(answer);
    EXPECT_EQ(problem.status, bad.status) << problem.detail;
    if (bad.pointer) {
        EXPECT_THAT(detail_at(problem.errors, bad.pointer), HasSubstr(bad.sentence));
    } else {
        EXPECT_THAT(problem.detail, HasSubstr(bad.sentence));
    }
    EXPECT_EQ(schema_faults(Json::parse(to_json(problem)), "Problem"), std::vector<std::string>{});
}

const std::string kFopdt = R"({"type": "fopdt", "K": 1, "T": 1, "L": 1)";

INSTANTIATE_TEST_SUITE_P(
    Text, Refuses,
    testing::Values(
        BadRequest{"Empty", "", 400, nullptr, "The body is empty"},
        BadRequest{"BrokenOff", "{\"plant\": {", 400, nullptr, "ends too early"},
        BadRequest{"TrailingComma", "{\"plant\": 1,}", 400, nullptr, "no comma after the last"},
        BadRequest{"SingleQuotes", "{'plant': 1}", 400, nullptr, "double quotes"},
        BadRequest{"BareNaN", R"({"plant": {"type": "fopdt", "K": NaN}})", 400, nullptr, "JSON has no NaN"},
        BadRequest{"BareInfinity", R"({"plant": {"K": -Infinity}})", 400, nullptr, "JSON has no NaN or Infinity"},
        BadRequest{"SecondLineIsNamed", "{\n  \"plant\": oops}", 400, nullptr, "line 2, column 12"},
        BadRequest{"NotUtf8", "{\"name\": \"\xff\"}", 400, nullptr, "not JSON"},
        BadRequest{"NumberBeyondDouble", R"({"plant": {"type": "fopdt", "K": 1e999}})", 422, "/plant/K",
                   "1e999 is too large"},
        BadRequest{"MemberTwice", R"({"timeout_s": 1, "timeout_s": 2})", 422, "/timeout_s", "given twice"},
        BadRequest{"TooDeep", std::string(40, '[') + std::string(40, ']'), 422, nullptr, "nested more than 32"},
        BadRequest{"AnArray", "[1, 2]", 422, "", "the request is an array; it must be an object"},
        BadRequest{"NothingInIt", "{}", 422, "", "plant, record or ultimate is missing"}),
    case_name);

INSTANTIATE_TEST_SUITE_P(
    Plants, Refuses,
    testing::Values(
        BadRequest{"TextForNumber", with_plant(R"({"type": "fopdt", "K": "2", "T": 1, "L": 1})"), 422, "/plant/K",
                   "K is \"2\", a string; it must be a number. Write 2 without quotes."},
        BadRequest{"NaNAsText", with_plant(R"({"type": "fopdt", "K": "NaN", "T": 1, "L": 1})"), 422, "/plant/K",
                   "NaN and Infinity are not accepted"},
        BadRequest{"DecimalComma", with_plant(R"({"type": "fopdt", "K": "2,5", "T": 1, "L": 1})"), 422, "/plant/K",
                   "decimal sign in JSON is the point"},
        BadRequest{"NullForNumber", with_plant(R"({"type": "fopdt", "K": null, "T": 1, "L": 1})"), 422, "/plant/K",
                   "K is null; it must be a number"},
        BadRequest{"NegativeDeadTime", with_plant(R"({"type": "fopdt", "K": 1, "T": 1, "L": -1})"), 422, "/plant/L",
                   "L is -1; it must be >= 0"},
        BadRequest{"MissingDeadTime", with_plant(R"({"type": "fopdt", "K": 1, "T": 1})"), 422, "/plant/L",
                   "L is missing"},
        BadRequest{"NoGain", with_plant(R"({"type": "fopdt", "K": 0, "T": 1, "L": 1})"), 422, "/plant/K",
                   "gain 0 cannot be controlled"},
        BadRequest{"Huge", with_plant(R"({"type": "fopdt", "K": 1e300, "T": 1, "L": 1})"), 422, "/plant/K",
                   "at most 1e30"},
        BadRequest{"Tiny", with_plant(R"({"type": "fopdt", "K": 1, "T": 1e-300, "L": 1})"), 422, "/plant/T",
                   "0 or at least 1e-30"},
        BadRequest{"NoType", with_plant(R"({"K": 1})"), 422, "/plant/type", "it must be fopdt, sopdt"},
        BadRequest{"UnknownType", with_plant(R"({"type": "foptd", "K": 1})"), 422, "/plant/type",
                   "Did you mean fopdt?"},
        BadRequest{"NonlinearWithoutEquations", with_plant(R"({"type": "nonlinear", "states": {"h": 1}})"), 422,
                   "/plant/equations", "equations is missing"},
        BadRequest{"StateThatIsNoNumber", with_plant(R"({"type": "nonlinear", "states": {"h": "1"}})"), 422,
                   "/plant/states/h", "it must be a number"},
        BadRequest{"EquationThatIsNoText", with_plant(R"({"type": "nonlinear", "equations": {"h": 1}})"), 422,
                   "/plant/equations/h", "string"},
        BadRequest{"AnInputThatMovesNothing",
                   with_plant(R"({"type": "nonlinear", "states": {"h": 0}, "equations": {"h": "-h"},
                                  "input": {"name": "q", "nominal": 1}, "output": "h"})"),
                   422, "/plant/output", "enters no derivative of the output"},
        BadRequest{"AnInputThatMovesNothingAtTheOperatingPoint",
                   with_plant(R"({"type": "nonlinear", "states": {"x": 0, "z": 0},
                                  "equations": {"x": "z*q - x", "z": "-z"},
                                  "input": {"name": "q", "nominal": 1}, "output": "x"})"),
                   422, "/plant/output", "relative degree is undefined at the operating point"},
        BadRequest{"AModeOutOfReachThatIsUnstable", with_plant(R"({"type": "nonlinear", "states": {"x": 1, "z": 0},
                                  "equations": {"x": "q - x + z", "z": "z"},
                                  "input": {"name": "q", "nominal": 1}, "output": "x"})"),
                   422, "/plant/equations", "The linearisation at the operating point is not supported."},
        BadRequest{"UnknownNameInAnEquation",
                   with_plant(R"({"type": "nonlinear", "states": {"h": 1}, "equations": {"h": "q - hh"},
                                  "input": {"name": "q", "nominal": 1}, "output": "h"})"),
                   422, "/plant/equations/h", "hh"},
        BadRequest{"UncertaintyInPlantUnits", with_plant(kFopdt + R"(, "uncertainty": {"L": [2.4, 3.6]}})"), 422,
                   "/plant/uncertainty/L", "factors of the nominal value"},
        BadRequest{"UncertaintySwapped", with_plant(kFopdt + R"(, "uncertainty": {"K": [1.2, 0.8]}})"), 422,
                   "/plant/uncertainty/K", "low <= 1 <= high"},
        BadRequest{"UncertaintyZero", with_plant(kFopdt + R"(, "uncertainty": {"K": [0, 1.2]}})"), 422,
                   "/plant/uncertainty/K/0", "> 0"},
        BadRequest{"UncertaintyOfWhatIsNotThere", with_plant(kFopdt + R"(, "uncertainty": {"T1": [0.9, 1.2]}})"), 422,
                   "/plant/uncertainty/T1", "T1 is not a field here"},
        BadRequest{"UncertaintyNoPair", with_plant(kFopdt + R"(, "uncertainty": {"K": 0.2}})"), 422,
                   "/plant/uncertainty/K", "a pair [low, high] of factors"},
        BadRequest{"EmptySet", with_plant(R"({"type": "set", "plants": []})"), 422, "/plant/plants", "0 elements"},
        BadRequest{
            "FaultInsideASet",
            with_plant(R"({"type": "set", "plants": [)" + kFopdt + R"(}, {"type": "fopdt", "K": 0, "T": 1, "L": 1}]})"),
            422, "/plant/plants/1/K", "gain 0"},
        BadRequest{"SetInsideASet", with_plant(R"({"type": "set", "plants": [{"type": "set", "plants": []}]})"), 422,
                   "/plant/plants/0/type", "it must be fopdt"},
        BadRequest{"OtherNameForDeadTime", with_plant(kFopdt + R"(, "delay": 1})"), 422, "/plant/delay",
                   "did you mean L?"},
        BadRequest{"PlantIsText", with_plant("\"hello\""), 422, "/plant", "\"hello\" is unknown"},
        BadRequest{"EmptyDenominator", with_plant(R"({"type": "transfer_function", "num": [1], "den": []})"), 422,
                   "/plant/den", "den has 0 numbers"},
        BadRequest{"ZeroDenominator", with_plant(R"({"type": "transfer_function", "num": [1], "den": [0, 0]})"), 422,
                   "/plant/den", "only zeros"},
        BadRequest{"ZeroNumerator", with_plant(R"({"type": "transfer_function", "num": [0], "den": [1, 1]})"), 422,
                   "/plant/num", "only zeros"},
        BadRequest{"Improper", with_plant(R"({"type": "transfer_function", "num": [1, 0, 0], "den": [0, 1, 1]})"), 422,
                   "/plant/num", "num has degree 2 and den degree 1"},
        BadRequest{"CoefficientIsNoNumber", with_plant(R"({"type": "transfer_function", "num": [1], "den": [1, "x"]})"),
                   422, "/plant/den/1", "den[1] is \"x\""},
        BadRequest{"PoleWithoutConjugate", with_plant(R"({"type": "zpk", "K": 1, "poles": [-3, [-1, 2]]})"), 422,
                   "/plant/poles/1", "Add [-1, -2]"},
        BadRequest{"MoreZerosThanPoles", with_plant(R"({"type": "zpk", "K": 1, "zeros": [-1, -2], "poles": [-3]})"),
                   422, "/plant/zeros", "no more zeros than poles"},
        BadRequest{"MatrixNotSquare",
                   with_plant(R"({"type": "state_space", "A": [[1, 2], [3]], "B": [1, 0], "C": [1, 0]})"), 422,
                   "/plant/A/1", "A must be square"},
        BadRequest{"InputOfOtherLength", with_plant(R"({"type": "state_space", "A": [[-1]], "B": [1, 0], "C": [1]})"),
                   422, "/plant/B", "B has 2 numbers and A 1 rows"},
        BadRequest{"OscillatoryWithoutDamping", with_plant(R"({"type": "sopdt", "K": 1, "T": 1, "L": 0})"), 422,
                   "/plant/zeta", "zeta is missing"},
        BadRequest{"HiddenUnstableMode",
                   with_plant(R"({"type": "state_space", "A": [[1, 0], [0, -1]], "B": [0, 1], "C": [1, 1]})"), 422,
                   "/plant/A", "cannot reach it"}),
    case_name);

INSTANTIATE_TEST_SUITE_P(
    Options, Refuses,
    testing::Values(
        BadRequest{"PlantAndRecord", request_with(R"("record": {"dt": 1, "u": [0, 1], "y": [0, 1]})"), 422, "/record",
                   "both given"},
        BadRequest{"UnknownField", request_with(R"("x": 1)"), 422, "/x", "x is not a field here"},
        BadRequest{"UnknownMethod", request_with(R"("tune": [{"method": "simcc"}])"), 422, "/tune/0/method",
                   "Did you mean simc?"},
        BadRequest{"NoMethodNamed", request_with(R"("tune": [{"Ms": 1.4}])"), 422, "/tune/0/method",
                   "method is missing"},
        BadRequest{"NoMethods", request_with(R"("tune": [])"), 422, "/tune", "it must have 1 to 50"},
        BadRequest{"OneMethodOutsideAList", request_with(R"("tune": {"method": "simc"})"), 422, "/tune",
                   "an array of methods"},
        BadRequest{"LimitBelowOne", request_with(R"("tune": [{"method": "robust", "Ms": 0.9}])"), 422, "/tune/0/Ms",
                   "Ms is 0.9; it must be > 1"},
        BadRequest{"UnknownOption", request_with(R"("tune": [{"method": "robust", "MS": 1.4}])"), 422, "/tune/0/MS",
                   "did you mean Ms?"},
        BadRequest{"OptionOfNoMethod", request_with(R"("tune": [{"method": "all", "tauc": 1, "zzz": 1}])"), 422,
                   "/tune/0/tauc", "did you mean tau_c?"},
        BadRequest{"OptionThatSuitsNoMethod", request_with(R"("tune": [{"method": "all", "Ms": 0.5}])"), 422,
                   "/tune/0/Ms", "it must be > 1"},
        BadRequest{"TwoFilters",
                   request_with(R"("tune": [{"method": "robust", "filter": {"Tf": 1, "Tf_over_Td": 0.1}}])"), 422,
                   "/tune/0/filter", "at most 1"},
        BadRequest{"TenMillionPoints", request_with(R"("evaluate": {"points": 10000000})"), 422, "/evaluate/points",
                   "0 (no traces) or a whole number from 2 to 20000"},
        BadRequest{"OnePoint", request_with(R"("evaluate": {"points": 1})"), 422, "/evaluate/points", "points is 1;"},
        BadRequest{"NoStep", request_with(R"("evaluate": {"load_step": 0})"), 422, "/evaluate/load_step",
                   "different from 0"},
        BadRequest{"HorizonInWords", request_with(R"("evaluate": {"horizon": "long"})"), 422, "/evaluate/horizon",
                   "a number > 0 or \"auto\""},
        BadRequest{"LimitsSwapped", request_with(R"("evaluate": {"actuator": {"min": 0, "max": 0}})"), 422,
                   "/evaluate/actuator/max", "max must be > min"},
        BadRequest{"IdentifiedWithoutRecord", request_with(R"("uncertainty": "identified")"), 422, "/uncertainty",
                   "needs a record"},
        BadRequest{"NoTime", request_with(R"("timeout_s": 0)"), 422, "/timeout_s", "> 0"},
        BadRequest{"IntegralTimeZero", request_with(R"("baseline": {"Kp": 1, "Ti": 0})"), 422, "/baseline/Ti",
                   "\"Ti\": null"},
        BadRequest{"KickOfTheSetPoint", request_with(R"("baseline": {"Kp": 1, "Td": 1, "c": 1})"), 422, "/baseline/c",
                   "infinite kick"},
        BadRequest{"FilterWithoutTime",
                   request_with(R"("baseline": {"Kp": 1, "filter": {"type": "measurement_first_order"}})"), 422,
                   "/baseline/filter/Tf", "Tf is missing"},
        BadRequest{
            "FilterNamedTwice",
            request_with(R"("baseline": {"Kp": 1, "Td": 1, "filter": {"type": "derivative", "Tf": 1, "N": 10}})"), 422,
            "/baseline/filter/N", "both given"},
        BadRequest{"TimeWithoutFilter", request_with(R"("baseline": {"Kp": 1, "filter": {"Tf": 1}})"), 422,
                   "/baseline/filter", "its type is none"},
        BadRequest{"GainZero", request_with(R"("baseline": {"form": "series", "Kp": 0, "Ti": 1})"), 422, "/baseline/Kp",
                   "form parallel"},
        BadRequest{"AllGainsZero", request_with(R"("baseline": {"form": "parallel", "Kp": 0})"), 422, "/baseline/Kp",
                   "all 0"},
        BadRequest{"NonlinearWithoutIntegral", request_with(R"("baseline": {"form": "npid", "Kp": 1})"), 422,
                   "/baseline/Ti", "Ti is missing"},
        BadRequest{"NonlinearTiNull", request_with(R"("baseline": {"form": "npid", "Kp": 1, "Ti": null})"), 422,
                   "/baseline/Ti", "form ideal"},
        BadRequest{"NonlinearDeltaZero",
                   request_with(R"("baseline": {"form": "npid", "Kp": 1, "Ti": 5, "delta_r": 0})"), 422,
                   "/baseline/delta_r", "must be > 0"},
        BadRequest{"NonlinearWeight", request_with(R"("baseline": {"form": "npid", "Kp": 1, "Ti": 5, "b": 0.5})"), 422,
                   "/baseline/b", "b = 1 and c = 0"},
        BadRequest{
            "NonlinearMeasurementFilter",
            request_with(
                R"("baseline": {"form": "npid", "Kp": 1, "Ti": 5, "filter": {"type": "measurement_first_order", "Tf": 1}})"),
            422, "/baseline/filter", "none or derivative"},
        BadRequest{"NonlinearGainZero", request_with(R"("baseline": {"form": "npid", "Kp": 0, "Ti": 5})"), 422,
                   "/baseline/Kp", "0"},
        BadRequest{
            "LoopThatCannotBeFormed",
            R"({"plant": {"type": "transfer_function", "num": [1, 1], "den": [1, 2]}, "baseline": {"Kp": 1, "Ti": 1, "Td": 1}})",
            422, "/baseline/filter", "Give the controller a filter"}),
    case_name);

INSTANTIATE_TEST_SUITE_P(
    Records, Refuses,
    testing::Values(
        BadRequest{"OtherLengths", with_record(R"({"t": [0, 1, 2], "u": [0, 1], "y": [0, 1, 2]})"), 422, "/record/u",
                   "u has 2 numbers and y 3"},
        BadRequest{"NoTimes", with_record(R"({"u": [0, 1], "y": [0, 1]})"), 422, "/record/t",
                   "give the times as an array, or the spacing as dt"},
        BadRequest{"NoMeasurement", with_record(R"({"dt": 1, "u": [0, 1]})"), 422, "/record/y", "y is missing"},
        BadRequest{"NullSample", with_record(R"({"dt": 1, "u": [0, 1], "y": [0, null]})"), 422, "/record/y/1",
                   "y[1] is null"},
        BadRequest{"TooManySamples",
                   with_record(R"({"dt": 1, "u": [0, 1], "y": [0)" +
                               [] {
                                   std::string zeros;
                                   for (int i = 0; i < 2'000'000; ++i) zeros += ",0";
                                   return zeros;
                               }() +
                               "]}"),
                   422, "/record/y", "2000001 numbers; it must have 2 to 2000000"},
        BadRequest{"PartThatEndsBeforeItStarts",
                   with_record(R"({"dt": 1, "u": [0, 1, 1], "y": [0, 0, 1], "from": 2, "to": 1})"), 422, "/record/to",
                   "to is 1 and from 2; the part that is used must end after it starts"},
        BadRequest{"PartBesideTheRecord", with_record(R"({"dt": 1, "u": [0, 1, 1], "y": [0, 0, 1], "from": 7})"), 422,
                   "/record/from", "It runs from 0 to 2. Choose a wider part."},
        BadRequest{"CsvAndArrays", with_record(R"({"csv": "t,u,y\n0,0,0", "y": [1, 2]})"), 422, "/record/y",
                   "together with csv"},
        BadRequest{"CsvWithoutLines", with_record(R"({"csv": "t,u,y\n"})"), 422, "/record/csv", "no line of numbers"},
        BadRequest{"CsvHeadingUnknown", with_record(R"({"csv": "t,u,y\n0,0,0\n", "columns": {"y": "PV"}})"), 422,
                   "/record/columns/y", "the headings are \"t\", \"u\" and \"y\""},
        BadRequest{"CsvCellIsNoNumber", with_record(R"({"csv": "t,u,y\n0,0,0\n1,0,oops\n"})"), 422, "/record/csv",
                   "Line 3, column \"y\": \"oops\" is not a number."},
        BadRequest{"UnknownModel", R"({"record": {"dt": 1, "u": [0, 1], "y": [0, 1]}, "identify": {"model": "foptd"}})",
                   422, "/identify/model", "Did you mean fopdt?"}),
    case_name);

TEST(BadRequests, EveryFaultIsReportedAtOnce) {
    const auto answer = prepare_job(
        R"({"plant": {"type": "fopdt", "K": "2", "T": [], "L": -1}, "timeout": 5, "tune": [{"method": "no"}], "evaluate": {"points": 1}})");
    const auto& errors = std::get<Problem>(answer).errors;
    std::vector<std::string> pointers;
    for (const FieldError& error : errors) pointers.push_back(error.pointer);
    EXPECT_THAT(pointers, testing::UnorderedElementsAre("/timeout", "/plant/K", "/plant/T", "/plant/L",
                                                        "/tune/0/method", "/evaluate/points"));
}

TEST(BadRequests, PointersEscapeTheirNames) {
    const auto answer = prepare_job(request_with(R"("a/b~c": 1)"));
    EXPECT_EQ(std::get<Problem>(answer).errors.at(0).pointer, "/a~1b~0c");
}

TEST(BadRequests, EvaluateNamesTheControllerInTheList) {
    const Answer answer = evaluate_call(
        R"({"plant": {"type": "transfer_function", "num": [1, 1], "den": [1, 2]}, "controllers": [{"Kp": 1, "Ti": 1}, {"Kp": 1, "Ti": 1, "Td": 1}]})",
        {});
    EXPECT_EQ(answer.status, 422);
    EXPECT_THAT(answer.body, HasSubstr("\"/controllers/1/filter\""));
}

TEST(BadRequests, IdentifyAnswersARecordOfThreePointsWithItsReason) {
    const Answer answer = identify_call(R"({"record": {"dt": 1, "u": [0, 1, 1], "y": [0, 0, 1]}})", {});
    EXPECT_EQ(answer.status, 422);
    EXPECT_EQ(schema_faults(Json::parse(answer.body), "Problem"), std::vector<std::string>{});
    EXPECT_GT(Json::parse(answer.body)["detail"].get<std::string>().size(), 30u);
}

TEST(BadRequests, AConstantRecordIsNotIdentifiable) {
    std::string y, u;
    for (int i = 0; i < 200; ++i) {
        y += std::string(i ? "," : "") + "20";
        u += std::string(i ? "," : "") + "50";
    }
    const Answer answer = identify_call(R"({"record": {"dt": 1, "u": [)" + u + R"(], "y": [)" + y + "]}}", {});
    EXPECT_EQ(answer.status, 422);
    EXPECT_EQ(Json::parse(answer.body)["type"], "not-identifiable");
}

TEST(BadRequests, ARecordThatDeterminesNoModelComesBackAsItWasRead) {
    std::string csv = "t;u;y\n";
    for (int i = 0; i < 5000; ++i) csv += std::to_string(2 * i) + ";7;" + (i == 9 ? "" : std::to_string(i % 3)) + "\n";
    const Answer answer = identify_call(Json{{"record", {{"csv", csv}}}, {"identify", {{"traces", true}}}}.dump(), {});
    ASSERT_EQ(answer.status, 422);
    const Json problem = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(problem, "Problem"), std::vector<std::string>{});
    const Json& record = problem["record"];
    EXPECT_EQ(record["t"].size(), 2000u);
    EXPECT_EQ(record["t"].front(), 0);
    EXPECT_EQ(record["t"].back(), 9998);
    EXPECT_EQ(record["u"], Json(std::vector<double>(2000, 7)));
    EXPECT_EQ(record["y"].back(), 4999 % 3);
}

TEST(BadRequests, ARecordThatDeterminesNoModelSaysWhenUMoves) {
    std::string csv = "t;u;y\n";
    for (int i = 0; i < 200; ++i)
        csv += std::to_string(i) + (i < 50 ? ";0;" : i < 120 ? ";5;" : ";2;") + std::to_string(i % 7) + "\n";
    const Json request{{"record", {{"csv", csv}}}, {"identify", {{"method", "relay_fourier"}}}};
    const Answer answer = identify_call(request.dump(), {});
    ASSERT_EQ(answer.status, 422) << answer.body;
    const Json problem = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(problem, "Problem"), std::vector<std::string>{});
    EXPECT_EQ(problem["record"]["move_times"], Json::array({50, 120}));
}

TEST(BadRequests, ARecordThatDeterminesNoModelIsShownByThreeRowsInFull) {
    std::string csv = "t;u;y;sp\n";
    for (int i = 0; i < 501; ++i) csv += std::to_string(1747040000 + i) + ".25;7;1.23456789;3\n";
    const Answer answer = identify_call(Json{{"record", {{"csv", csv}}}}.dump(), {});
    ASSERT_EQ(answer.status, 422);
    EXPECT_LT(answer.body.size(), 1500u);
    const Json problem = Json::parse(answer.body);
    EXPECT_EQ(schema_faults(problem, "Problem"), std::vector<std::string>{});
    const Json& record = problem["record"];
    EXPECT_EQ(record["samples"], 501);
    EXPECT_EQ(record["t"], Json::array({1747040000.25, 1747040250.25, 1747040500.25}));
    EXPECT_EQ(record["y"], Json::array({1.23456789, 1.23456789, 1.23456789}));
    EXPECT_EQ(record["r"], Json::array({3, 3, 3}));
}

TEST(BadRequests, LimitsOfUAreTwoAscendingNumbers) {
    const auto fault_of = [](const std::string& limits) {
        const Answer answer =
            identify_call(R"({"record": {"dt": 1, "u": [0, 1], "y": [0, 1], "u_limits": )" + limits + "}}", {});
        EXPECT_EQ(answer.status, 422) << limits;
        const Json problem = Json::parse(answer.body);
        return problem.contains("errors") ? problem["errors"][0].dump() : problem.dump();
    };
    EXPECT_THAT(fault_of("[100, 0]"),
                HasSubstr("u_limits is [100,0]; the first number is the lower limit and must be below"));
    EXPECT_THAT(fault_of("[5, 5]"), HasSubstr("must be below the second"));
    EXPECT_THAT(fault_of("[0]"), HasSubstr("it must be [low, high], such as [0, 100]"));
    EXPECT_THAT(fault_of("100"), HasSubstr("it must be [low, high]"));
    EXPECT_THAT(fault_of("[0, \"all\"]"), HasSubstr("/record/u_limits/1"));
    EXPECT_THAT(fault_of("[0, 1e31]"), HasSubstr("/record/u_limits/1"));
}

TEST(BadRequests, ASetPointIsAsLongAsTheRecord) {
    const Answer answer = identify_call(R"({"record": {"dt": 1, "u": [0, 1, 1], "y": [0, 1, 1], "r": [1, 1]}})", {});
    EXPECT_EQ(answer.status, 422);
    EXPECT_THAT(answer.body, HasSubstr("r has 2 numbers and y 3; they must have the same number."));
}

// Damaged requests of every kind: the answer is always a valid problem or a job, never an exception. Seeded.
TEST(BadRequests, DamagedTextsNeverDoMoreThanBeRefused) {
    std::mt19937 random(1);
    const auto pick = [&](std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
    };
    std::vector<std::string> whole;
    const Json document = Json::parse(examples_json());
    for (const Json& example : document["examples"]) {
        if (!example["request"].contains("record")) whole.push_back(example["request"].dump());
    }
    whole.push_back(
        R"({"record": {"csv": "Time [s];OP;\"PV, raw\"\n2024-01-01T00:00:00;1,5;2\n2024-01-01T00:00:01;;2\n", "columns": {"y": 3}}})");
    const std::vector<std::string> pieces = {
        "null", "-1", "1e400", "\"\"", "[]",     "{}", "0", ",",    "\"",   "}",
        "]",    ":",  "\\",    "NaN",  "1e-320", "\n", ";", "true", "\xff", "9999999999999999999"};
    int refused = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string text = whole[pick(whole.size())];
        for (std::size_t damage = 0; damage <= pick(3); ++damage) {
            const std::size_t at = pick(text.size()), length = pick(8);
            text.replace(at, std::min(length, text.size() - at), pick(4) == 0 ? "" : pieces[pick(pieces.size())]);
            if (text.empty()) text = " ";
        }
        const auto answer = prepare_job(text);
        if (const auto* problem = std::get_if<Problem>(&answer)) {
            ++refused;
            const Json written = Json::parse(to_json(*problem));
            ASSERT_EQ(schema_faults(written, "Problem"), std::vector<std::string>{}) << text;
            ASSERT_FALSE(problem->detail.empty()) << text;
        } else {
            ASSERT_TRUE(Json::accept(std::get<PreparedJob>(answer).request_json)) << text;
        }
    }
    EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace tunewright::api
