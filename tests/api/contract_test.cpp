// Plants and controllers: golden pairs of JSON and engine types, in both directions.
#include "api/contract/controller.h"
#include "api/contract/plant/plant.h"
#include "api/contract/request.h"
#include "support.h"

namespace tunewright::api {
namespace {

template <class Form>
Form read_plant(const std::string& text) {
    const auto decoded = decode<Plant>(plant_contract(), text);
    EXPECT_TRUE(decoded.faults.empty()) << detail_at(decoded.faults, "none");
    return std::get<Form>(decoded.value);
}

template <class Form>
Form read_controller(const std::string& text) {
    const auto decoded = decode<Controller>(controller_contract(), text);
    EXPECT_TRUE(decoded.faults.empty()) << detail_at(decoded.faults, "none");
    return std::get<Form>(decoded.value);
}

TEST(Plants, EachTypeIsWrittenAsItIsRead) {
    for (const char* text : {
             R"({"type":"fopdt","K":2,"T":10,"L":3})",
             R"({"type":"fopdt","K":-1,"T":-1,"L":0.1})",
             R"({"type":"sopdt","K":1.5,"T1":12,"T2":4,"L":2})",
             R"({"type":"sopdt","K":1,"T":0.333,"zeta":0.167,"L":0})",
             R"({"type":"ipdt","K":0.05,"L":4,"T":1.25})",
             R"({"type":"transfer_function","num":[1],"den":[1,3,3,1],"L":0.5})",
             R"({"type":"zpk","K":6,"zeros":[-1],"poles":[-3,[-1,2],[-1,-2]],"L":0.2})",
             R"({"type":"state_space","A":[[-1,0],[1,-2]],"B":[1,0],"C":[0,1],"D":0,"L":0})",
         }) {
        const auto decoded = decode<Plant>(plant_contract(), text);
        EXPECT_TRUE(decoded.faults.empty()) << text;
        EXPECT_EQ(encode(plant_contract(), decoded.value), text);
        EXPECT_EQ(schema_faults(Json::parse(text), "Plant"), std::vector<std::string>{}) << text;
    }
}

TEST(Plants, MembersGoToTheirPlaces) {
    const auto fopdt = read_plant<Fopdt>(R"({"type": "fopdt", "K": 2, "T": 10, "L": 3})");
    EXPECT_EQ(fopdt.K, 2);
    EXPECT_EQ(fopdt.T, 10);
    EXPECT_EQ(fopdt.L, 3);
    const auto oscillatory = read_plant<OscillatorySopdt>(R"({"type": "sopdt", "K": 1, "T": 3, "zeta": 0.2, "L": 4})");
    EXPECT_EQ(oscillatory.T, 3);
    EXPECT_EQ(oscillatory.zeta, 0.2);
    const auto zpk = read_plant<Zpk>(R"({"type": "zpk", "K": 6, "poles": [[-1, 2], [-1, -2]]})");
    EXPECT_EQ(zpk.poles.at(0), std::complex<double>(-1, 2));
    EXPECT_TRUE(zpk.zeros.empty());
    EXPECT_EQ(zpk.L, 0);
}

TEST(Plants, StateSpaceTakesColumnsAndRowsAsMatrixProgramsWriteThem) {
    const auto plant = read_plant<StateSpace>(
        R"({"type": "state_space", "A": [[-1, 0], [1, -2]], "B": [[1], [0]], "C": [[0, 1]], "D": [[0.5]]})");
    EXPECT_EQ(plant.B, (std::vector<double>{1, 0}));
    EXPECT_EQ(plant.C, (std::vector<double>{0, 1}));
    EXPECT_EQ(plant.D, 0.5);
}

TEST(Controllers, TheIdealFormIsMeantWithoutAFormAndDefaultsAreTheContracts) {
    const auto pid = read_controller<IdealPid>(R"({"Kp": 1.2})");
    EXPECT_EQ(pid.Kp, 1.2);
    EXPECT_FALSE(pid.has_integral());
    EXPECT_EQ(pid.Td, 0);
    EXPECT_EQ(pid.b, 1);
    EXPECT_EQ(pid.c, 0);
    EXPECT_EQ(pid.filter.type, FilterType::none);
}

TEST(Controllers, AnAnswersControllerCanBeSentBack) {
    const char* text =
        R"({"form":"ideal","Kp":-4.78,"Ti":0.29,"Td":0.128,"b":1,"c":0,"filter":{"type":"measurement_second_order","Tf":0.0128},"action":"direct"})";
    const auto decoded = decode<Controller>(controller_contract(), text);
    EXPECT_TRUE(decoded.faults.empty());
    EXPECT_EQ(encode(controller_contract(), decoded.value), text);
    EXPECT_EQ(schema_faults(Json::parse(text), "Controller"), std::vector<std::string>{});
}

TEST(Controllers, NoIntegralActionIsNullInBothDirections) {
    const auto decoded = decode<Controller>(controller_contract(), R"({"form": "ideal", "Kp": 1, "Ti": null})");
    EXPECT_FALSE(std::get<IdealPid>(decoded.value).has_integral());
    EXPECT_TRUE(Json::parse(encode(controller_contract(), decoded.value))["Ti"].is_null());
}

TEST(Controllers, NGivesTheFilterTimeOfItsOwnForm) {
    EXPECT_DOUBLE_EQ(
        read_controller<IdealPid>(R"({"Kp": 1, "Td": 2, "filter": {"type": "derivative", "N": 10}})").filter.Tf, 0.2);
    EXPECT_DOUBLE_EQ(read_controller<ParallelPid>(
                         R"({"form": "parallel", "Kp": 4, "Kd": 2, "filter": {"type": "derivative", "N": 5}})")
                         .filter.Tf,
                     0.1);
    EXPECT_DOUBLE_EQ(read_controller<SeriesPid>(
                         R"({"form": "series", "Kp": 1, "Ti": 3, "Td": 1, "filter": {"type": "derivative", "N": 8}})")
                         .filter.Tf,
                     0.125);
}

TEST(Controllers, NWithoutDerivativeLeavesNothingToFilter) {
    EXPECT_EQ(read_controller<IdealPid>(R"({"Kp": 1, "Ti": 5, "Td": 0, "filter": {"type": "derivative", "N": 10}})")
                  .filter.type,
              FilterType::none);
}

TEST(Controllers, NWithoutProportionalGainIsRefused) {
    const auto decoded = decode<Controller>(
        controller_contract(), R"({"form": "parallel", "Ki": 1, "Kd": 1, "filter": {"type": "derivative", "N": 10}})");
    EXPECT_NE(detail_at(decoded.faults, "/filter/N").find("give Tf > 0 itself"), std::string::npos)
        << detail_at(decoded.faults, "/filter/N");
}

TEST(Controllers, PureIntegralActionIsAParallelForm) {
    const auto pid = read_controller<ParallelPid>(R"({"form": "parallel", "Ki": -0.5})");
    EXPECT_EQ(pid.Kp, 0);
    EXPECT_EQ(pid.Ki, -0.5);
    EXPECT_EQ(Json::parse(encode(controller_contract(), Controller(pid)))["action"], "direct");
}

TEST(Controllers, CIsAllowedWithADerivativeFilterOrWithoutDerivative) {
    read_controller<IdealPid>(R"({"Kp": 1, "Td": 1, "c": 1, "filter": {"type": "derivative", "N": 10}})");
    read_controller<IdealPid>(R"({"Kp": 1, "c": 1})");
}

TEST(Equivalents, AMissingSeriesFormTellsWhy) {
    Equivalents equivalents;
    equivalents.parallel.Kp = 1;
    equivalents.why_no_series = "Ti < 4 Td.";
    const Json written = Json::parse(encode(equivalents_contract(), equivalents));
    EXPECT_TRUE(written["series"].is_null());
    EXPECT_EQ(written["why_null"]["series"], "Ti < 4 Td.");
    EXPECT_EQ(schema_faults(written, "Equivalents"), std::vector<std::string>{});
    equivalents.series = SeriesPid{};
    EXPECT_FALSE(Json::parse(encode(equivalents_contract(), equivalents)).contains("why_null"));
}

TEST(Requests, TheDefaultsOfTheContractHold) {
    const auto decoded = decode<JobRequest>(job_contract(), request_with(""));
    ASSERT_TRUE(decoded.faults.empty());
    EXPECT_EQ(decoded.value.timeout_s, 60);
    EXPECT_EQ(decoded.value.evaluate.points, 400);
    EXPECT_EQ(decoded.value.evaluate.setpoint_step, 1);
    EXPECT_FALSE(decoded.value.evaluate.rank_Ms);
    ASSERT_EQ(decoded.value.tune.size(), 1u);
    EXPECT_EQ(decoded.value.tune[0].method, "robust");
}

TEST(Requests, OptionsAreKeptByPath) {
    const auto decoded = decode<JobRequest>(
        job_contract(),
        request_with(R"("tune": [{"method": "robust", "Ms": 1.7, "filter": {"Tf": 0.01}, "controller": "PI"}])"));
    ASSERT_TRUE(decoded.faults.empty()) << detail_at(decoded.faults, "none");
    const MethodOptions& options = decoded.value.tune.at(0).options;
    EXPECT_EQ(options.number("Ms"), 1.7);
    EXPECT_EQ(options.number("filter/Tf"), 0.01);
    EXPECT_EQ(options.text("controller"), "PI");
    EXPECT_FALSE(options.has("Mt"));
}

TEST(Requests, AllIsAWordOrAMethodWithAnyMethodsOptions) {
    const auto word = decode<JobRequest>(job_contract(), request_with(R"("tune": "all")"));
    ASSERT_EQ(word.value.tune.size(), 1u);
    EXPECT_EQ(word.value.tune[0].method, "all");
    const auto object = decode<JobRequest>(
        job_contract(), request_with(R"("tune": [{"method": "all", "Ms": 1.6, "tau_c": 2, "controller": "PI"}])"));
    ASSERT_TRUE(object.faults.empty()) << detail_at(object.faults, "none");
    EXPECT_EQ(object.value.tune.at(0).options.number("Ms"), 1.6);
    EXPECT_EQ(object.value.tune.at(0).options.number("tau_c"), 2);
    EXPECT_EQ(schema_faults(Json::parse(R"({"method": "all", "Ms": 1.6, "tau_c": 2})"), "Method"),
              std::vector<std::string>{});
}

TEST(Requests, AnOptionOfAllNeedSuitOneMethodOnly) {
    const auto decoded =
        decode<JobRequest>(job_contract(), request_with(R"("tune": [{"method": "all", "controller": "P"}])"));
    ASSERT_TRUE(decoded.faults.empty()) << detail_at(decoded.faults, "none");
    EXPECT_EQ(decoded.value.tune.at(0).options.text("controller"), "P");
    EXPECT_EQ(schema_faults(Json::parse(R"({"method": "all", "controller": "P"})"), "Method"),
              std::vector<std::string>{});
}

TEST(Requests, EvaluateOptionsGoToTheirPlaces) {
    const auto decoded = decode<JobRequest>(
        job_contract(),
        request_with(
            R"("evaluate": {"setpoint_step": -2, "load_step": 3, "horizon": 50, "points": 0, "actuator": {"min": -1, "max": 4}, "noise": {"std": 0.1, "sample_time": 0.5}, "rank_limits": {"Ms": 1.8}})"));
    ASSERT_TRUE(decoded.faults.empty()) << detail_at(decoded.faults, "none");
    const EvaluateOptions& options = decoded.value.evaluate;
    EXPECT_EQ(options.setpoint_step, -2);
    EXPECT_EQ(options.load_step, 3);
    EXPECT_EQ(options.horizon, 50);
    EXPECT_EQ(options.points, 0);
    EXPECT_EQ(options.actuator->min, -1);
    EXPECT_EQ(options.actuator->max, 4);
    EXPECT_EQ(options.noise->std, 0.1);
    EXPECT_EQ(options.noise->sample_time, 0.5);
    EXPECT_EQ(options.rank_Ms, 1.8);
}

TEST(Requests, RecordsGoToTheEngineWithTheirTimes) {
    auto decoded = decode<JobRequest>(
        job_contract(),
        R"({"record": {"dt": 0.5, "u": [0, 1, 1], "y": [5, 5, 6], "u0": -1, "y0": 4, "kind": "step"}, "identify": {"model": "ipdt_lag"}})");
    ASSERT_TRUE(decoded.faults.empty());
    const TuningRequest request = to_engine(std::move(decoded.value));
    ASSERT_TRUE(request.record.has_value());
    EXPECT_EQ(request.record->t, (std::vector<double>{0, 0.5, 1}));
    EXPECT_EQ(request.record->u, (std::vector<double>{0, 1, 1}));
    EXPECT_EQ(request.record->y, (std::vector<double>{5, 5, 6}));
    EXPECT_EQ(request.record->u0, -1);
    EXPECT_EQ(request.record->y0, 4);
    EXPECT_EQ(request.record->kind, RecordKind::step);
    EXPECT_EQ(request.identify.model, ModelChoice::ipdt_lag);
    EXPECT_FALSE(request.subject.has_value());
}

TEST(Requests, RecordsTakeTheirSetPointAndLimitsToTheEngine) {
    auto decoded = decode<JobRequest>(
        job_contract(),
        R"({"record": {"dt": 1, "u": [0, 1, 1, 2], "y": [5, 5, 6, 7], "r": [6, 6, 8, 8], "u_limits": [0, 100], "from": 1}})");
    ASSERT_TRUE(decoded.faults.empty());
    const TuningRequest arrays = to_engine(std::move(decoded.value));
    EXPECT_EQ(arrays.record->r, (std::vector<double>{6, 8, 8})) << "the part that is used";
    EXPECT_EQ(arrays.record->y, (std::vector<double>{5, 6, 7}));
    EXPECT_EQ(arrays.record->u_limits, (std::array<double, 2>{0, 100}));

    auto text = decode<JobRequest>(job_contract(), R"({"record": {"csv": "t,u,y,sp\n0,1,2,3\n1,1,2,\n2,1,3,4\n"}})");
    ASSERT_TRUE(text.faults.empty());
    EXPECT_EQ(to_engine(std::move(text.value)).record->r, (std::vector<double>{3, 3, 4}));

    auto none = decode<JobRequest>(job_contract(), R"({"record": {"csv": "t,u,y\n0,1,2\n1,1,2\n"}})");
    const TuningRequest without = to_engine(std::move(none.value));
    EXPECT_TRUE(without.record->r.empty());
    EXPECT_FALSE(without.record->u_limits.has_value());
}

TEST(PreparedJobs, KeepTheRequestAsSentAndHashItsMeaning) {
    const auto one = std::get<PreparedJob>(
        prepare_job(R"({"name": "TIC", "timeout_s": 5, "plant": {"type": "fopdt", "K": 2.50, "T": 1e1, "L": 3}})"));
    const auto same = std::get<PreparedJob>(
        prepare_job(R"({"plant": {"L": 3, "T": 10, "K": 2.5, "type": "fopdt"}, "timeout_s": 5.0, "name": "TIC"})"));
    EXPECT_EQ(one.name, "TIC");
    EXPECT_EQ(one.timeout_s, 5);
    EXPECT_EQ(one.request_json, R"({"name":"TIC","timeout_s":5,"plant":{"type":"fopdt","K":2.50,"T":1e1,"L":3}})");
    EXPECT_EQ(one.request_hash, same.request_hash);
    EXPECT_EQ(one.request_hash.size(), 64u);
    const auto other = std::get<PreparedJob>(
        prepare_job(R"({"name": "TIC", "timeout_s": 5, "plant": {"type": "fopdt", "K": 2.51, "T": 10, "L": 3}})"));
    EXPECT_NE(one.request_hash, other.request_hash);
}

// The rows before the part give u and a disturbance if its first cells are blank.
TEST(Contract, APartOfARecordKeepsWhatHoldsAtItsStart) {
    const auto read =
        decode<IdentifyRequest>(identify_request_contract(), R"({"record": {"from": 2, "columns": {"d": ["q"]},
        "csv": "t,u,y,q\n0,3,0,8\n1,,0,\n2,,1,\n3,4,1,\n4,,2,9\n5,,3,\n"}})");
    ASSERT_TRUE(read.faults.empty()) << read.faults.front().detail;
    const Record& record = read.value.read.record;
    EXPECT_EQ(record.t.front(), 2);
    EXPECT_EQ(record.u.front(), 3);
    EXPECT_EQ(record.d[0].values.front(), 8);
    EXPECT_EQ(record.u[1], 4);
}

}  // namespace
}  // namespace tunewright::api
